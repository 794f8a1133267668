#!/usr/bin/env python3
"""Hand-set constants of the rooms that estimate, with their class and value.

Usage: scripts/constants.py [ROOM]...
A comment beside a constant states its class; without one it is tuned.
  tuned      an estimate depends on it
  prior      states an unknown before any reading shows it, its mean, deviation, walk or bounds: // Prior: kName
  limit      beyond it a reading or a file is refused, far from all that a machine has: // Limit: kName
  warning    only whether a warning is given depends on it: // Warning: kName
  numerical  a step, tolerance or rounding of the arithmetic, on which no result depends: // Numerical: kName
A dimension at compile time and a factor 0.5, 1 or 2 of other constants do not count.
"""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROOMS = ("estimation", "crank", "boom", "pipeline", "calibration")
_NUMBER = re.compile(r"(?<![\w.\]])(?:\d[\d']*\.?\d*(?:[eE][-+]?\d+)?)(?![\w.])")
_UNIT = re.compile(r"kTwoPi / 360\.0|360\.0 / kTwoPi|60\.0 / kTwoPi")
_STATEMENT = re.compile(
    r"^[ ]*(?:static |inline )*constexpr (?:const )?(double|int|std::size_t|std::u?int64_t|Doubt|SwingLimits) "
    r"(k[A-Z]\w*[^;()]*?(?:\([^;]*?\)[^;()]*?)*);", re.M)
_DEFAULT = re.compile(r"^[ ]+(?:double|int|std::size_t) ([a-z][a-z0-9_]*[a-z0-9])\{([^{};\n]+)\};", re.M)
_CLASS = re.compile(r"// (Limit|Prior|Numerical|Warning): ((?:\w+(?:,\s+(?://+ )?)?)+)")
_SIZE = r"\w<[^<>;\n]*\b{0}\b|\w\[[^];\n]*\b{0}\b[^];\n]*\]\S* ?[;{{]|constexpr[^;\n]*=[^;\n]*\b{0}\b"
_MATHEMATICS = {0.5, 1.0, 2.0}

Constant = collections.namedtuple("Constant", "path line name value type")


def without_comments(text):
    """Text without comments, of equal length, so that positions stay."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", lambda found: re.sub(r"[^\n]", " ", found.group()), text, flags=re.S)


def declarators(statement):
    """(offset, name, value) of each, split at commas outside brackets."""
    depth, begin = 0, 0
    for i, letter in enumerate(statement + ","):
        if letter == "," and depth == 0:
            name = re.match(r"\s*(\w+)(?:\[\w*\])?\s*=?\s*", statement[begin:i])
            yield begin, name.group(1), statement[begin + name.end():i]
            begin = i + 1
        depth += (letter in "([{") - (letter in ")]}")


def is_hand_set(value):
    numbers = {float(number.group().replace("'", "")) for number in _NUMBER.finditer(value)}
    if not numbers or value == "0" or _UNIT.fullmatch(value.strip()):
        return False
    return not (re.search(r"\bk[A-Z]\w*", value) and numbers <= _MATHEMATICS)


def constants_of(path, code):
    for found in _STATEMENT.finditer(code):
        for offset, name, value in declarators(found.group(2)):
            if is_hand_set(value):
                yield Constant(path, code.count("\n", 0, found.start(2) + offset) + 1, name, value, found.group(1))
    for found in _DEFAULT.finditer(code) if path.suffix == ".h" else ():
        number = _NUMBER.search(found.group(2))
        if number and float(number.group().replace("'", "")) not in (0.0, 1.0):
            yield Constant(path, code.count("\n", 0, found.start(1)) + 1, found.group(1), found.group(2), "default")


def class_of(constant, codes):
    for word, names in _CLASS.findall(constant.path.read_text()):
        if constant.name in re.findall(r"\w+", names):
            return word.lower()
    own = codes if constant.path.suffix == ".h" else {constant.path: codes[constant.path]}
    if constant.type in ("int", "std::size_t") and any(
            re.search(_SIZE.format(constant.name), code) for code in own.values()):
        return "size"
    return "tuned"


def main():
    if {"-h", "--help"} & set(sys.argv[1:]):
        sys.exit(print(__doc__))
    count = collections.Counter()
    for room in sys.argv[1:] or ROOMS:
        paths = sorted((ROOT / "src/hammer_loads" / room).iterdir())
        codes = {path: without_comments(path.read_text()) for path in paths if path.suffix in (".h", ".cpp")}
        for path, code in codes.items():
            for constant in constants_of(path, code):
                kind = class_of(constant, codes)
                count[kind] += 1
                if kind != "size":
                    value = " ".join(constant.value.split())
                    print(f"{room}/{path.name}:{constant.line} {kind} {constant.name} = {value}")
    print(", ".join(f"{number} {kind}" for kind, number in sorted(count.items())))


if __name__ == "__main__":
    main()
