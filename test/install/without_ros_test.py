"""HAMMER_LOADS_ROS=OFF: what it installs, and a project that uses it. The libraries are this build's own, which link nothing of
ROS: .ci/nightly compiles them without it."""
import shutil
import sys

import pytest

from support import BUILD, HERE, LIBRARIES, PROGRAMS, SOURCE, configure, said

OPTIONS = ["-DHAMMER_LOADS_ROS=OFF", "-DBUILD_TESTING=OFF", "-DCMAKE_BUILD_WITH_INSTALL_RPATH=ON", "-DCMAKE_BUILD_TYPE=Release",
           # A package of ROS that is looked for is not to be found, whatever is on this machine.
           "-DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_roscpp=ON"]
NAMES = ["core", "boom", "life", "ledger", "settings", "grapple", "calibration", "pipeline", "tables"]
COMMANDS = ["turn_table", "evaluate", "accuracy", "grapple_table", "count_cycles", "life"]
MODULE = "lib/python3/dist-packages/hammer_loads_py"


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    build, place = (tmp_path_factory.mktemp(name) for name in ("build", "prefix"))
    said(configure(SOURCE, build, f"-DCMAKE_INSTALL_PREFIX={place}", *OPTIONS))
    for folder, files in (("lib", [LIBRARIES / f"libhammer_loads_{name}.so" for name in NAMES]),
                          ("bin", [PROGRAMS / name for name in COMMANDS])):
        (build / folder).mkdir(exist_ok=True)
        for file in files:
            shutil.copy(file, build / folder)
    if (BUILD / "devel" / MODULE).exists():
        shutil.copytree(BUILD / "devel" / MODULE, build / MODULE, dirs_exist_ok=True)
    said(f"cmake --install {build}")
    return place


def test_installs_and_is_used_by_cmake_and_by_pkg_config(prefix, tmp_path):
    said(f"PKG_CONFIG_PATH={prefix}/lib/pkgconfig " +
         configure(HERE / "use_without_ros", tmp_path, f"-DCMAKE_PREFIX_PATH={prefix}") + f" && cmake --build {tmp_path}")
    right = said(f"{prefix}/bin/turn_table --summary --level rocker")
    for program in ("by_cmake", "by_pkg_config"):
        assert said(f"{tmp_path}/{program}") == right
        libraries = said(f"ldd {tmp_path}/{program}")
        assert f"libhammer_loads_pipeline.so => {prefix}/lib/" in libraries
        assert "libros" not in libraries


def test_nothing_installed_names_ros(prefix):
    """Channel first: the words are found where ROS is."""
    assert "libroscpp" in said(f"ldd {LIBRARIES}/libhammer_loads_ros.so")
    files = [path for path in prefix.rglob("*") if path.is_file()]
    linked = [path for path in files if path.suffix == ".so" or path.parent.name == "bin"]
    texts = [path for path in files if path.suffix in (".cmake", ".pc")]
    assert len(linked) >= 14 and len(texts) >= 4
    for path in linked:
        libraries = said(f"ldd {path} || true")  # a script is no program
        assert not [word for word in ("libros", "catkin", "libkdl_parser") if word in libraries], path
    for path in texts:
        assert not [word for word in ("roscpp", "catkin", "kdl_parser", "rosbag") if word in path.read_text()], path


def test_python_finds_the_module_and_its_parameters(prefix):
    module = prefix / MODULE
    if not module.exists():
        pytest.skip("built without pybind11")
    code = "import hammer_loads_py as h; print(h.__file__, round(h.Hammer.from_yaml().pulse(level='rocker')['amplitude']))"
    assert said(f'PYTHONPATH={module.parent} {sys.executable} -c "{code}"') == f"{module}/__init__.py 40558\n"
    assert (module / "__init__.pyi").exists() and (module / "py.typed").exists()
