"""Beginnings of doc comments in src/, scripts/, fleet/ and test/, and names of tests: both begin with a subject or a verb."""
import ast
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = [path for path in sorted((ROOT / "src").rglob("*")) if path.suffix in (".h", ".cpp")]
SCRIPTS = [path for folder in ("src", "scripts", "fleet", "test") for path in sorted((ROOT / folder).rglob("*"))
           if path.suffix == ".py" or (path.is_file() and not path.suffix and path.read_bytes().startswith(b"#!/usr/bin/env python"))]
TESTS = sorted((ROOT / "test").rglob("*.cpp"))

# A clause or a preposition; a comment within a function may state a condition or refer to the line below it.
BEGINNING = r"(?:what|of|that|those|so|as|the same|same|whether|likewise|nor|how|why|which|who|its|their|also|too)\b"
DOC_BEGINNING = re.compile(rf"(?:{BEGINNING}|(?:where|it|they)\b)", re.I)
REMARK_BEGINNING = re.compile(BEGINNING, re.I)
DOC = re.compile(r"\s*///(?!<)\s?(.*)")
MEMBER = re.compile(r".*\S\s*///<\s?(.*)")
REMARK = re.compile(r"\s*//(?!/)\s?(.*)")
SENTENCE = re.compile(r"(?<=[a-z0-9)\]]\. )(?:What|Of|That|Those|So|As|Whether|Likewise|Nor|Which)\b.{0,40}")

NAME = (r"(?:Of|What|That|Those|As|Same|Its|It|In|At|From|With|Without|By|On|Beyond|Beside|Before|After|Between|Until|Within|Where|"
        r"When|Who|Which|And|But|Both|Nor|To|For|How|Also|Too|Far|Than|So|If)")
PRIVATE = r"(?:Tells?|Told|Says?|Said|Believe[sd]?|Anew|Doubt(?:s|ed|ful)?|ThatGives?|PressForce|BlankStrokes?|DeadPoints?|Foretold)"
BAD_NAME = re.compile(rf"{NAME}(?![a-z])|\w*(?<![A-Z]){PRIVATE}(?![a-z])")


def beginnings(text):
    """(line, first words, pattern) of each comment block in C++ source; units and code in front do not count."""
    before = None
    for number, line in enumerate(text.splitlines(), 1):
        for kind, pattern in ((DOC, DOC_BEGINNING), (MEMBER, DOC_BEGINNING), (REMARK, REMARK_BEGINNING)):
            match = kind.match(line)
            if match:
                if before is not kind or kind is MEMBER:
                    yield number, re.sub(r"^(\[[^\]]*\]|`[^`]*`:?)\s*", "", match.group(1)), pattern
                break
        before = kind if match else None


def bad_beginnings(text):
    return [f"{number}: {words[:60]}" for number, words, pattern in beginnings(text) if pattern.match(words)]


def bad_sentences(text):
    """Sentences within doc comments that begin with a clause; lines of a block are joined."""
    lines = [DOC.match(line) or REMARK.match(line) for line in text.splitlines()]
    joined = " ".join(match.group(1).strip() if match else "\n" for match in lines)
    return SENTENCE.findall(joined)


def docstrings(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.FunctionDef, ast.ClassDef)):
            words = ast.get_docstring(node)
            if words:
                yield words


def names_of_tests(text):
    return re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\w+,\s*(?:DISABLED_)?(\w+)\)", text, re.M)


def names_of_python_tests(text):
    """Names as those of C++ tests: test_2_a_log_ends is ALogEnds."""
    return ["".join(word.capitalize() for word in name.split("_"))
            for name in re.findall(r"^\s*def test_(?:\d+_)?([a-z]\w*)\(", text, re.M)]


def test_comments_begin_with_a_subject_or_a_verb():
    texts = {path: path.read_text() for path in SOURCES}
    assert sum(1 for text in texts.values() for _ in beginnings(text)) > 5000
    assert [f"{path.relative_to(ROOT)}:{found}" for path, text in texts.items() for found in bad_beginnings(text)] == []


def test_sentences_of_comments_begin_with_a_subject():
    assert [(str(path.relative_to(ROOT)), found) for path in SOURCES for found in bad_sentences(path.read_text())] == []


def test_docstrings_begin_with_a_subject_or_a_verb():
    found = [(str(path.relative_to(ROOT)), words) for path in SCRIPTS for words in docstrings(path.read_text())]
    assert len(found) > 300
    assert [(path, words[:60]) for path, words in found if DOC_BEGINNING.match(words)] == []


def test_names_of_tests_state_a_behaviour():
    names = [name for path in TESTS for name in names_of_tests(path.read_text())]
    names += [name for path in SCRIPTS if ROOT / "test" in path.parents for name in names_of_python_tests(path.read_text())]
    assert len(names) > 1000
    assert [name for name in names if BAD_NAME.match(name)] == []
