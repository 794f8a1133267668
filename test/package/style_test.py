"""Style of the source: clang-format of Debian 12, catkin_lint."""
import re
import shutil

import pytest
import support

CLANG_FORMAT = 14  # of Debian 12; other versions format otherwise


def clang_format_version():
    if shutil.which("clang-format") is None:
        return None
    return int(re.search(r"version (\d+)", support.run("clang-format", "--version").stdout)[1])


needs_clang_format = pytest.mark.skipif(clang_format_version() != CLANG_FORMAT,
                                        reason=f"needs clang-format {CLANG_FORMAT}, has {clang_format_version()}")


@needs_clang_format
def test_every_cpp_file_is_formatted():
    sources = support.files(".cpp", ".h")
    assert len(sources) > 500
    done = support.run("clang-format", "--dry-run", "-Werror", *sources)
    files = sorted(set(re.findall(r"^(\S+?):\d+:\d+: error", done.stdout, re.MULTILINE)))
    assert files == [], "run clang-format -i"
    assert done.returncode == 0, done.stdout


def test_catkin_lint_has_no_warning():
    if shutil.which("catkin_lint") is None:
        pytest.skip("needs the package catkin-lint")
    done = support.run("catkin_lint", "--offline", "-W2", support.SOURCE)
    assert "checked 1 packages" in done.stdout
    assert [line for line in done.stdout.splitlines() if re.search(r": (error|warning): ", line)] == []
