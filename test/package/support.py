"""Files of the source, as git knows them."""
import pathlib
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def run(*command):
    return subprocess.run([str(word) for word in command], cwd=str(SOURCE), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)


def files(*suffixes):
    """All files of the package with these suffixes, relative to the source; none of third_party."""
    folders = ("src", "test", "examples", "fleet", "scripts")
    return sorted(str(path.relative_to(SOURCE)) for folder in folders for path in (SOURCE / folder).rglob("*")
                  if path.suffix in suffixes)
