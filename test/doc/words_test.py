"""Words of README.md, CONTRIBUTING.md, doc/ and msg/: vocabulary, beginnings and lengths, captions, links, options."""
import functools
import os
import pathlib
import re
import subprocess
import xml.etree.ElementTree

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = os.environ.get("HAMMER_LOADS_PROGRAMS")
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md"] + sorted((ROOT / "doc").glob("*.md"))
MESSAGES = sorted((ROOT / "msg").glob("*.msg"))
FIRST_READ = {"README.md", "your_machine.md", "api.md", "limits.md", "install.md"}  # by every user, also a beginner
WORDS_FIRST_READ, WORDS = 25, 40  # longest sentence; derivations need some more

# Private words (pattern) and the field's (replacement).
VOCABULARY = [
    (r"rods? (that gives?|gives?)\b", "elastic connecting rod"),
    (r"\bring(?! buffer)\b|\brings\b", "vibration of the connecting rod"),
    (r"blows? into nothing|blank strokes?|strokes? without a tool", "blank firing"),
    (r"press force", "hold-down force"),
    (r"\bplay\b", "joint clearance"),
    (r"\b(a|per|each|every|whole|last|next|half a|quarter of a|all|of the|over the|within a) turns?\b(?! by)", "revolution"),
    (r"\b(tells?|told|says?|said)\b", "states, reports; stated"),
    (r"\b(believes?|believed|trusts?|trusted)\b", "accepts, uses"),
    (r"\banew\b", "is reset, restarts"),
    (r"\bdoubts?\b|\bdoubted\b|\bdoubtful\b", "uncertainty, inflated variance"),
    (r"\brivals?\b", "second hypothesis"),
    (r"\b(takes?|taken|took) (up|back)\b", "update, correct; revert"),
    (r"\bforetold\b", "predicted"),
    (r"\b(a|the|of a|machine's) drawings?\b", "data sheet, nominal parameters"),
    (r"machines as they are|\breal machines\b", "simulated machine with, measured machine"),
    (r"loads of steel", "section loads"),
    (r"\bcertificates?\b", "test report"),
    (r"\btypical machines?\b", "machine with a typical sensor"),
    (r"\bdead points?\b", "zero moment arm"),
    (r"\bmade-up\b", "simulated"),
]
HOUSING = (r"\bthe hull(?! (frame|axes|pitch|wrench|motion|moment|inertia|mass|force)\b)", "the housing")  # messages: hull
DEVIATION = r"(?<![Ss]tandard )(?<![Ss]ystematic )\bdeviations?\b"  # a geometric one is of a path (grapple.md)
CELL = re.compile(r"(That|So|Of|Likewise|As above|The same)\b|What\b(?!.*\?$)")
SENTENCE = re.compile(r"(So|Of|Likewise|As above|Nor)\b|What\b(?!.*\?$)")


def without_code(text):
    """Markdown without fences, indented blocks, generated parts and inline code."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    text = re.sub(r"<!-- (\S+?)(?:: [\w-]+)? -->.*?<!-- /\1 -->", "", text, flags=re.S)
    text = re.sub(r"^    .*$", "", text, flags=re.M)
    text = re.sub(r"^\[.*?\]: .*$", "", text, flags=re.M)
    return re.sub(r"`[^`\n]*`", "`", text)


def without_links(text):
    return re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)


def cells_of(text):
    for line in text.splitlines():
        if line.startswith("|") and not line.startswith("|---"):
            yield from (cell.strip() for cell in re.sub(r"\\\|", "/", line).strip("|").split("|"))


def paragraphs_of(text):
    """Prose without tables and headings; a list's items are paragraphs."""
    lines = ["" if line.startswith(("|", "#")) else re.sub(r"^\s*(- |\d+\. )", "\n", line) for line in text.splitlines()]
    for paragraph in re.split(r"\n\s*\n", "\n".join(lines)):
        joined = " ".join(paragraph.split())
        if joined:
            yield joined


def sentences_of(paragraph):
    paragraph = re.sub(r"\*\*|\*", "", paragraph)
    for sentence in re.split(r"(?<=[\w)`\]][.?!:;]) +(?=[A-Z`(\[])", re.sub(r"\b(e\.g|i\.e|vs|al|Fig)\.", r"\1", paragraph)):
        if sentence:
            yield sentence


def words_in(sentence):
    return len(re.findall(r"[A-Za-z][A-Za-z'-]+", sentence))


def complaints(text, path):
    """Every breach of the rules in a page's text."""
    name, found = path.name, []
    plain = without_links(without_code(text))
    if name == "tables.md":  # its rows are written from the database
        plain = re.sub(r"^\|.*$", "", plain, flags=re.M)
    flat = " ".join(plain.split())
    for pattern, better in VOCABULARY + [HOUSING]:
        for match in re.finditer(pattern, flat, re.I):
            found.append(f"'{flat[max(0, match.start() - 30):match.end() + 20]}': {better}")
    if name not in ("grapple.md", "papers.md"):
        for match in re.finditer(DEVIATION, flat):
            found.append(f"'{flat[max(0, match.start() - 30):match.end() + 20]}': standard deviation")
    for cell in cells_of(plain):
        if CELL.match(cell):
            found.append(f"cell begins with '{cell[:40]}'")
    for paragraph in paragraphs_of(plain):
        for sentence in sentences_of(paragraph):
            if SENTENCE.match(sentence):
                found.append(f"sentence begins with '{sentence[:60]}'")
            most = WORDS_FIRST_READ if name in FIRST_READ else WORDS
            if words_in(sentence) > most:
                found.append(f"{words_in(sentence)} words: '{sentence[:90]}...'")
    lines = text.splitlines()
    for number, line in enumerate(lines):
        if line.startswith("!["):
            caption = lines[number + 2] if number + 2 < len(lines) else ""
            if not re.match(r"\*[A-Z].{30}", caption):
                found.append(f"picture without a caption: {line[:60]}")
    return found


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_page_follows_the_rules_of_language(path):
    assert complaints(path.read_text(), path) == []


@pytest.mark.parametrize("path", MESSAGES, ids=lambda path: path.name)
def test_message_comments_use_the_vocabulary(path):
    comments = [re.sub(r"`[^`]*`", "", line.partition("#")[2]) for line in path.read_text().splitlines()]
    found = [f"{comment}: {better}" for comment in comments for pattern, better in VOCABULARY + [(DEVIATION, "standard deviation")]
             if re.search(pattern, comment, re.I)]
    fields = [line.partition("#")[2] for line in path.read_text().splitlines() if re.match(r"\w.*#", line)]
    found += [comment for comment in fields if CELL.match(re.sub(r"^\s*(\[[^\]]*\])?\s*", "", comment).capitalize())]
    assert found == []


def test_readme_is_short():
    assert len((ROOT / "README.md").read_text().splitlines()) <= 180


def anchors_of(page):
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(path):
    for target in re.findall(r"\]\(([^)\s]+)\)", path.read_text()):
        if target.startswith("http"):
            continue
        name, _, anchor = target.partition("#")
        page = path.parent / name if name else path
        assert page.exists(), target
        assert not anchor or anchor in anchors_of(page), target


def test_start_page_links_every_document():
    linked = set(re.findall(r"\]\(([\w.]+\.md)\)", (ROOT / "doc" / "README.md").read_text()))
    assert {path.name for path in (ROOT / "doc").glob("*.md")} - {"README.md"} == linked


def commands_on(path):
    """Program or launch file, and the rest of the command, of each command on a page; wrapped lines are joined."""
    text = path.read_text().replace("\\\n", " ")
    yield from re.findall(r"(?:rosrun|roslaunch) hammer_loads (\S+)([^\n`]*)", text)
    for cell in re.findall(r"^\| `((?:\\\||[^`|])*)`", text, re.M):  # tables of commands
        if cell.split()[0].isidentifier() and " " in cell:
            yield cell.split()[0], cell.partition(" ")[2]


@functools.lru_cache(maxsize=None)
def help_of(program):
    done = subprocess.run([str(pathlib.Path(PROGRAMS) / program), "--help"], stdout=subprocess.PIPE, universal_newlines=True,
                          check=True)
    text = done.stdout
    if program == "calibrate":  # two ways of use, each with its help
        text += subprocess.run([str(pathlib.Path(PROGRAMS) / program), "--linkage", "TABLE", "--help"], stdout=subprocess.PIPE,
                               universal_newlines=True, check=True).stdout
    return set(re.findall(r"--[a-z][a-z-]*", text))


def arguments_of(launch):
    tree = xml.etree.ElementTree.parse(str(ROOT / "launch" / launch)).getroot()
    return {arg.get("name") for arg in tree.findall("arg") if arg.get("value") is None}


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_launch_arguments_exist(path):
    for program, rest in commands_on(path):
        if program.endswith(".launch"):
            unknown = set(re.findall(r"(\w+):=", rest.partition("#")[0])) - arguments_of(program)
            assert not unknown, (program, unknown)


def test_arguments_of_the_demo_exist():
    text = (ROOT / "doc" / "api.md").read_text()
    named = set(re.findall(r"^\| `(\w+):=", text, re.M))
    assert named and named <= arguments_of("demo.launch")


@pytest.mark.skipif(not PROGRAMS, reason="HAMMER_LOADS_PROGRAMS is not set")
@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_options_of_commands_exist(path):
    for program, rest in commands_on(path):
        if (pathlib.Path(PROGRAMS) / program).exists():
            unknown = set(re.findall(r"--[a-z][a-z-]*", rest.partition("#")[0])) - help_of(program)
            assert not unknown, (program, unknown)
