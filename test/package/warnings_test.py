"""A warning states cause, consequence and action in at most 140 characters."""
import pathlib
import re

PIPELINE = pathlib.Path(__file__).resolve().parents[2] / "src" / "hammer_loads" / "pipeline"
LITERALS = re.compile(r'"((?:[^"\\\n]|\\.)*)"(?:\s*"((?:[^"\\\n]|\\.)*)")*', re.S)
TYPICAL = {"%s": "12345", "%zu": "12345", "%d": "12"}  # of a number some five characters


def texts():
    """Adjacent literals as the compiler joins them, with typical numbers."""
    for file in sorted(PIPELINE.glob("*warnings.cpp")):
        for found in LITERALS.finditer(file.read_text(encoding="utf-8")):
            text = "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', found[0]))
            text = re.sub(r"%[.0-9]*[a-z]+", lambda m: TYPICAL.get(m[0], "12345"), text).replace("%%", "%")
            if " " in text and "/" not in text.split(" ")[0]:
                yield file.name, text


def test_no_warning_is_longer_than_140_characters():
    found = list(texts())
    assert len(found) > 40
    assert [(file, len(text), text) for file, text in found if len(text) > 140] == []
