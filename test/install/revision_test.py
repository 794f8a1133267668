"""The revision that a log carries is that of the source as it was built."""
import os
import re
import shutil
import time

import pytest

from support import SOURCE, said


@pytest.fixture
def root(tmp_path, monkeypatch):
    """No repository around the folder, no settings of the user."""
    monkeypatch.delenv("GIT_DIR", raising=False)
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", "/dev/null")
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    return tmp_path


@pytest.fixture
def source(root):
    """A source of its own."""
    shutil.copytree(SOURCE / "cmake", root / "source" / "cmake")
    for name in ("package.xml", ".gitattributes"):
        shutil.copy(SOURCE / name, root / "source")
    return root / "source"


def git(folder, arguments):
    return said(f"git -c user.name=a -c user.email=a@b.invalid {arguments}", cwd=folder).strip()


def commit(source):
    for arguments in ("init -q", "add .", "commit -q -m one"):
        git(source, arguments)


def revision(root, source):
    """The one that a build writes into its header."""
    said(f"cmake -DSOURCE={source} -DHEADER={root}/source_revision.h -P {source}/cmake/revision.cmake", cwd=root)
    return re.fullmatch(r'#define HAMMER_LOADS_REVISION "(.*)"\n', (root / "source_revision.h").read_text())[1]


def test_follows_the_checkout_at_every_build_and_keeps_the_file_if_nothing_changed(root, source):
    commit(source)
    first = git(source, "rev-parse --short=12 HEAD")
    assert revision(root, source) == first
    old = time.time() - 3600.0
    os.utime(root / "source_revision.h", (old, old))
    assert revision(root, source) == first
    assert (root / "source_revision.h").stat().st_mtime == pytest.approx(old), "nothing is compiled again"
    with open(source / "package.xml", "a") as file:
        file.write("<!-- changed -->\n")
    assert revision(root, source) == first + "-dirty"
    git(source, "commit -q -a -m two")
    assert revision(root, source) == git(source, "rev-parse --short=12 HEAD") != first
    git(source, "tag -a v1 -m v1")
    assert revision(root, source) == "v1"


def test_is_unknown_outside_git_and_inside_another_repository(root, source):
    assert revision(root, source) == "unknown"
    git(root, "init -q")
    git(root, "commit -q --allow-empty -m other")
    assert revision(root, source) == "unknown"


def test_comes_with_an_archive(root, source):
    commit(source)
    git(source, "archive --prefix=copy/ -o ../copy.tar HEAD")
    said("tar xf copy.tar", cwd=root)
    found = revision(root, root / "copy")
    assert len(found) >= 7
    assert git(source, "rev-parse HEAD").startswith(found)
