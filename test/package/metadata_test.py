"""Files that package indexes, archives and citation tools read: package.xml, CHANGELOG.rst, CITATION.cff, debian/."""
import datetime
import re

import pytest
import support
import yaml

catkin_package = pytest.importorskip("catkin_pkg.package", reason="needs the package python3-catkin-pkg")
from catkin_pkg.changelog import get_changelog_from_path  # noqa: E402

SPDX = re.compile(r"^[A-Za-z0-9.+-]+$")
CFF_KEYS = {"cff-version", "message", "title", "authors"}  # required by the schema of 1.2.0
SUBSTITUTES = {"g++", "build-essential"}


@pytest.fixture(scope="module")
def package():
    return catkin_package.parse_package(str(support.SOURCE))  # validates as well


@pytest.fixture(scope="module")
def citation():
    return yaml.safe_load((support.SOURCE / "CITATION.cff").read_text())


@pytest.fixture(scope="module")
def changelog():
    return get_changelog_from_path(str(support.SOURCE), "hammer_loads")


def text(name):
    return (support.SOURCE / name).read_text()


def debian_list(field):
    """Names of all packages of a field, of every paragraph that has it."""
    source = re.sub(r"^#.*\n", "", text("debian/control"), flags=re.MULTILINE)
    blocks = re.findall(rf"^{field}:((?:.*\n)(?:[ ].*\n)*)", source, re.MULTILINE)
    return {re.split(r"[ (]", item.strip())[0] for block in blocks for item in block.split(",") if item.strip()}


def package_list(name):
    return {line.strip() for line in text("scripts/" + name).splitlines() if line.strip() and not line.startswith("#")}


def test_package_xml_names_people_places_and_licences(package):
    assert {url.type for url in package.urls} == {"website", "repository", "bugtracker"}
    assert all(url.url.startswith("https://") for url in package.urls)
    assert package.authors and package.maintainers
    assert [str(licence) for licence in package.licenses] == ["BSD-3-Clause", "BSD-3-Clause"]
    for licence in package.licenses:
        assert "Redistribution and use in source and binary forms" in text(licence.file)


def test_every_third_party_folder_has_its_licence_named(package):
    named = {licence.file for licence in package.licenses}
    folders = [path for path in (support.SOURCE / "third_party").iterdir() if path.is_dir()]
    assert folders
    for folder in folders:
        assert f"third_party/{folder.name}/LICENSE" in named
        assert f"\nFiles: third_party/{folder.name}/*\n" in text("debian/copyright")


def test_the_changelog_is_read_by_catkin_pkg(changelog, package):
    released = [version for version, _, _ in changelog.foreach_version()]
    assert package.version in released
    for version, date, entries in changelog.foreach_version():
        assert re.match(r"\d+\.\d+\.\d+$", version) and isinstance(date, datetime.datetime)
        assert entries, version


def test_every_file_has_the_same_version(package, citation):
    assert re.search(r"project\(hammer_loads VERSION (\S+)", text("CMakeLists.txt"))[1] == package.version
    assert str(citation["version"]) == package.version
    assert re.match(r"hammer-loads \((\S+)\)", text("debian/changelog"))[1] == package.version
    assert catkin_package.parse_package(str(support.SOURCE / "ros2" / "hammer_loads_msgs")).version == package.version


def test_the_release_has_one_date(package, changelog, citation):
    dates = {version: date.date() for version, date, _ in changelog.foreach_version()}
    assert citation["date-released"] == dates[package.version]
    assert dates[package.version].strftime("%d %b %Y") in text("debian/changelog").split("\n -- ")[1]


def test_the_citation_has_what_its_schema_requires(package, citation):
    assert CFF_KEYS <= set(citation)
    assert citation["cff-version"] == "1.2.0"
    assert citation["type"] == "software"
    for author in citation["authors"]:
        assert "name" in author or {"family-names", "given-names"} <= set(author)
    assert citation["license"] == str(package.licenses[0]) and SPDX.match(citation["license"])
    assert isinstance(citation["date-released"], datetime.date)
    assert citation["repository-code"] in {url.url for url in package.urls}


def test_debian_names_the_same_place_and_people(package):
    homepage = next(url.url for url in package.urls if url.type == "website")
    assert f"Homepage: {homepage}\n" in text("debian/control")
    person = package.maintainers[0]
    assert f"Maintainer: {person.name} <{person.email}>\n" in text("debian/control")


def test_the_scripts_install_what_the_debian_package_needs():
    installed = package_list("packages.txt") | SUBSTITUTES
    tools_of_the_package = {"debhelper-compat", "dh-python"}
    assert debian_list("Build-Depends") - tools_of_the_package - installed == set()
    needed = {name for name in debian_list("Depends") if not name.startswith("${") and name != "hammer-loads"}
    # By rosbash, ros-message-generation and, as an alternative to SciPy, python3-matplotlib.
    implied = {"python3-genpy", "rospack-tools", "ros-message-runtime", "python3-munkres"}
    assert needed - installed - implied == set()
