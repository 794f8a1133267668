"""Hand-set constants of the rooms that estimate, found in their source: for scripts/sensitivity and test/doc.

Each is of one class, by what is to be asked of it:
  tuned      an estimate depends on it; a test notices half or double: // Guard: Suite.Test of kName
  prior      what is said of an unknown before any reading shows it: its mean, deviation, walk or bounds; a test notices
             half or double: // Prior: Suite.Test of kName
  limit      beyond it a reading or a file is refused, far from all that a machine has, so that no estimate depends on
             it; its test says where it refuses: // Limit: Suite.Test of kName
  numerical  a step, tolerance or rounding of the arithmetic: results are the same with half and with double, so that
             no test may notice: // Numerical: kName
  size       a dimension at compile time
A factor 0.5, 1 or 2 of other constants is mathematics.
"""
import collections
import pathlib
import re

ROOMS = ("estimation", "crank", "boom", "pipeline")
_NUMBER = re.compile(r"(?<![\w.\]])(?:\d[\d']*\.?\d*(?:[eE][-+]?\d+)?)(?![\w.])")
_UNIT = re.compile(r"kTwoPi / 360\.0|360\.0 / kTwoPi|60\.0 / kTwoPi")
_STATEMENT = re.compile(
    r"^([ ]*)((?:static |inline )*constexpr )((?:const )?(?:double|int|std::size_t|std::u?int64_t|Doubt|SwingLimits) )"
    r"(k[A-Z]\w*[^;()]*?(?:\([^;]*?\)[^;()]*?)*);", re.M)
_DEFAULT = re.compile(r"^([ ]+)(double|int|std::size_t) ([a-z][a-z0-9_]*[a-z0-9])\{([^{};\n]+)\};", re.M)
_NAMES = r"((?:\w+(?:,\s+(?://+ )?)?)+)"
_GUARD = re.compile(r"// (Guard|Limit|Prior): ([\w/]+\.[\w/]+) of " + _NAMES)
_NUMERICAL = re.compile(r"// Numerical: " + _NAMES)
_MATHEMATICS = {0.5, 1.0, 2.0}


# begin, end: of the names and values of one statement; words: where its `constexpr` begins, and ends
Head = collections.namedtuple("Head", "begin end kind type words")


class Constant:
    """One name. spans: where its numbers stand in the text of its file; kind: as above, but for sizes."""

    def __init__(self, path, text, name, spans, head):
        self.path, self.name, self.spans, self.head, self.guard, self.kind = path, name, spans, head, None, "tuned"
        self.line = text.count("\n", 0, spans[0][0]) + 1
        self.value = ", ".join(text[a:b].strip() for a, b in spans)

    @property
    def room(self):
        return self.path.parent.name

    @property
    def id(self):
        return f"{self.room}/{self.path.name}:{self.name}"


def without_comments(text):
    """The same length: positions stay."""
    blank = lambda found: re.sub(r"[^\n]", " ", found.group())
    return re.sub(r"//[^\n]*|/\*.*?\*/", blank, text, flags=re.S)


def _declarators(text, start, end):
    """(name, begin, end of what follows it) of each, split at commas outside brackets."""
    depth, begin = 0, start
    for i in range(start, end + 1):
        if i == end or (text[i] == "," and depth == 0):
            name = re.match(r"\s*(\w+)", text[begin:i])
            yield name.group(1), begin + name.end(), i
            begin = i + 1
        elif text[i] in "([{":
            depth += 1
        elif text[i] in ")]}":
            depth -= 1


def heads_of(code):
    for found in _STATEMENT.finditer(code):
        kind = "global"
        if found.group(1):
            kind = "member" if "static" in found.group(2) else "local"
        yield Head(found.start(4), found.end(4), kind, found.group(3).strip(), found.span(2))


def constants_of(path):
    text = path.read_text()
    code = without_comments(text)
    found = []
    for head in heads_of(code):
        for name, begin, end in _declarators(code, head.begin, head.end):
            value = re.compile(r"(?:\[\w*\])?\s*=?\s*").match(code, begin).end()
            if not _NUMBER.search(code, value, end) or _UNIT.fullmatch(code[value:end].strip()) or code[value:end] == "0":
                continue  # made of others, or nothing to double
            if re.search(r"\bk[A-Z]\w*", code[value:end]) and _numbers(code[value:end]) <= _MATHEMATICS:
                continue
            spans = [(value, end)]
            if code[value] == "{":
                spans = [m.span() for m in _NUMBER.finditer(code, value, end)]
            found.append(Constant(path, code, name, spans, head))
    if path.suffix == ".h":
        for default in _DEFAULT.finditer(code):
            if _NUMBER.search(default.group(4)) and float(_number(default.group(4))) not in (0.0, 1.0):
                head = Head(default.start(3), default.end(), "default", default.group(2), None)
                found.append(Constant(path, code, default.group(3), [default.span(4)], head))
    named = lambda names: [constant for constant in found if constant.name in re.findall(r"\w+", names)]
    for word, guard, names in _GUARD.findall(text):
        for constant in named(names):
            constant.guard, constant.kind = guard, "tuned" if word == "Guard" else word.lower()
    for names in _NUMERICAL.findall(text):
        for constant in named(names):
            constant.kind = "numerical"
    return sorted(found, key=lambda constant: constant.spans)


def _number(text):
    return _NUMBER.search(text).group().replace("'", "")


def _numbers(text):
    return {float(number.group().replace("'", "")) for number in _NUMBER.finditer(text)}


def sources(root):
    for room in ROOMS:
        for path in sorted((pathlib.Path(root) / "src/hammer_loads" / room).iterdir()):
            if path.suffix in (".h", ".cpp"):
                yield path


def is_size(constant, code_of, seen):
    """A dimension at compile time: not tuned. code_of: text of each file; seen: the headers that it includes."""
    if constant.head.kind == "default" or constant.head.type in ("double", "Doubt"):
        return False
    uses = re.compile(r"\w<[^<>;\n]*\b{0}\b|\w\[[^];\n]*\b{0}\b[^];\n]*\]\S* ?[;{{]|constexpr[^;\n]*=[^;\n]*\b{0}\b".format(constant.name))
    return any(uses.search(code) for path, code in code_of.items() if path == constant.path or constant.path.name in seen[path])


def _includes(code_of):
    """Names of the headers that each file includes, by whatever way."""
    direct = {path: set(re.findall(r'#include "hammer_loads/\w+/(\w+\.h)"', path.read_text())) for path in code_of}
    by_name = {path.name: names for path, names in direct.items()}
    for names in direct.values():
        todo = list(names)
        while todo:
            more = by_name.get(todo.pop(), set()) - names
            names |= more
            todo += more
    return direct


def all_constants(root):
    """(all but sizes, sizes)"""
    code_of = {path: without_comments(path.read_text()) for path in sources(root)}
    seen = _includes(code_of)
    tuned, sizes = [], []
    for path in code_of:
        for constant in constants_of(path):
            (sizes if is_size(constant, code_of, seen) else tuned).append(constant)
    return tuned, sizes
