"""README.md and doc/ against what they speak of: rooms, parameter files, topics, messages, commands, symbols, citations."""
import collections
import pathlib
import re

import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "hammer_loads"
PARAMETER_FILES = ["hammer_mo100", "pipeline", "log", "life", "limits", "grapple_node"]
COMMANDS = {path.stem[:-len("_main")] for path in (SOURCE / "commands").glob("*_main.cpp")}
PYTHON_COMMANDS = {"report", "budget", "check", "test_report"}


def text_of(*paths):
    return "".join((ROOT / path).read_text() for path in paths)


def text_below(folder, suffix):
    return "".join(path.read_text() for path in sorted((ROOT / folder).rglob("*" + suffix)))


def section(text, heading):
    """From a heading that begins so to the next heading."""
    begin = text.index("\n" + heading) + 1
    return text[begin:].split("\n#")[0]


def rows_of(text):
    """Cells of the rows of tables whose first cell is in backquotes, which it loses."""
    rows = [[cell.strip() for cell in line[1:].split("|")] for line in text.splitlines() if line.startswith("| `")]
    return [[row[0].replace("`", ""), *row[1:]] for row in rows]


def parameters_in(name):
    """{key: value as a table shows it} of a file in config/."""
    def shown(node):
        return node.value if isinstance(node, yaml.ScalarNode) else "[" + ", ".join(map(shown, node.value)) + "]"
    return {key.value: shown(value) for key, value in yaml.compose(text_of(f"config/{name}.yaml")).value}


@pytest.mark.parametrize("name", PARAMETER_FILES)
def test_parameter_tables_hold_each_one_with_its_shipped_value(name):
    page = text_of("doc/parameters.md")
    heading = next(line for line in page.splitlines() if line.startswith("#") and f"config/{name}.yaml" in line)
    assert {row[0]: row[1] for row in rows_of(section(page, heading))} == parameters_in(name)


def topics_in_tables(heading):
    names = [row[0] for row in rows_of(section(text_of("doc/api.md"), heading))]
    return {name.replace("JAW", jaw) for name in names for jaw in ("left", "right")} - {"/diagnostics"}


def test_api_page_holds_every_topic_of_the_hammers_nodes():
    source = text_of("src/hammer_loads/ros/hammer_outputs.h")
    outputs = re.findall(r'^  Output<.*> \w+\{"(\w+)"', source, re.M)
    assert len(re.findall(r"Output<", source)) == len(outputs) + 1  # boom_wrench has one for each link
    inputs = re.findall(r'\{&InputTopics::\w+, "(\w+)"', text_of("src/hammer_loads/settings/input_topics.h"))
    assert topics_in_tables("## Topics") == {"~" + name for name in [*outputs, "boom_wrench/LINK"]} | set(inputs)


def test_api_page_holds_every_topic_of_the_grapples_nodes():
    source = text_of("src/hammer_loads/grapple_ros/grapple_flow.h")
    outputs = re.findall(r'^  Output<.*> \w+\{"(\w+)"', source, re.M)
    endings = re.findall(r'\("jaw_edge/" \+ jaw(?: \+ "(\w+)")?,', source)
    assert len(re.findall(r"Output<", source)) == len(outputs) + len(endings) == 5
    edges = [f"jaw_edge/{jaw}{ending}" for jaw in ("left", "right") for ending in endings]
    assert topics_in_tables("### Grapple\n") == {"~" + name for name in outputs + edges} | {"joint_states"}


def test_api_page_holds_every_message():
    assert {row[0] for row in rows_of(section(text_of("doc/api.md"), "## Messages"))} == {
        path.stem for path in (ROOT / "msg").iterdir()}


def test_api_page_holds_every_command_and_node_and_no_option_that_is_none():
    page = section(text_of("doc/api.md"), "## Commands")
    commands = COMMANDS | PYTHON_COMMANDS
    assert [name for name in commands if f"`{name}" not in page] == []
    assert {row[0].split()[0] for row in rows_of(page)} <= commands
    sources = text_below("src/hammer_loads", ".cpp") + text_below("src/hammer_loads", ".py")
    options = {option for row in rows_of(page) for option in re.findall(r"--[a-z-]+", row[0] + row[1])}
    assert [option for option in options if f'"{option}"' not in sources] == []


def test_every_file_that_readme_and_pages_name_exists():
    readme, api = text_of("README.md"), text_of("doc/api.md")
    named = [*re.findall(r"\]\(([\w./]+)\)", readme), *re.findall(r"(?:config|launch|scripts)/\w[\w.]*", readme + api),
             *("src/" + path for path in re.findall(r"hammer_loads/\w+/\w+\.h", readme + api)),
             *("launch/" + path for path in re.findall(r"hammer_loads (\w+\.launch)", readme + api)),
             *("src/hammer_loads/" + path for path in re.findall(r"`((?:linkage|hammer|crank)/\w+\.h)`", text_of("doc/model.md")))]
    assert [path for path in named if not (ROOT / path).exists() and path != "doc/demo.png"] == []  # which scripts/demo makes


def rooms():
    """{room: rooms that it knows, with what these know in turn, and itself}, from the lowest up; arrows go up the table only."""
    knows = {}
    row = re.compile(r"^\| `(\w+)` \| [^|]+ \| [^|]+ \| ([^|;]*)(?:;[^|]*)?\|$", re.M)
    for room, stated in row.findall(text_of("doc/architecture.md")):
        words = re.findall("[a-z]+", stated)
        knows[room] = {room}.union(*(knows[lower] for lower in knows if lower in words or "all" in words))
    return knows


def test_architecture_page_has_a_row_for_every_room():
    assert {path.name for path in SOURCE.iterdir() if path.name != "__pycache__"} <= set(rooms())


def test_every_room_knows_what_it_includes():
    knows = rooms()
    assert len(knows) > 10
    for room, known in knows.items():
        sources = "".join(path.read_text() for path in (SOURCE / room).iterdir() if path.suffix in (".h", ".cpp"))
        assert set(re.findall(r'#include "hammer_loads/(\w+)/', sources)) <= known, room


Symbols = collections.namedtuple("Symbols", "symbols in_papers cpp yaml messages columns")


@pytest.fixture(scope="module")
def symbols():
    """The symbol table of doc/model.md: symbols here and in the papers, C++, YAML, and message or CSV names."""
    found = Symbols([], [], set(), set(), set(), set())
    for line in section(text_of("doc/model.md"), "## 8. Symbols").splitlines():
        if not line.startswith("| ") or line.startswith("| symbol"):
            continue
        own, papers, _, _, cpp, keys, names = (cell.strip() for cell in line.strip("|").split("|"))
        found.symbols.extend(symbol.strip() for symbol in own.split(","))
        paper = ""  # a symbol without one is of the paper before it
        for symbol in filter(None, map(str.strip, papers.split(","))):
            paper = symbol[:3] if symbol.startswith(("P0 ", "P1 ")) else paper
            found.in_papers.append(symbol if symbol.startswith(paper) else paper + symbol)
        found.cpp.update(re.findall("`([^`]+)`", cpp))
        found.yaml.update(re.findall("`([^`]+)`", keys))
        found.messages.update(re.findall(r"`(\w+\.\w+)`", names))
        found.columns.update(re.findall(r"`evaluate: (\w+)`", names))
    return found


def test_symbol_table_holds_each_symbol_once(symbols):
    for names, least in ((symbols.symbols, 80), (symbols.in_papers, 40)):
        assert len(names) > least and "" not in names
        assert [name for name, count in collections.Counter(names).items() if count > 1] == []


def test_symbol_table_holds_every_symbol_of_the_formulas(symbols):
    """Formulas are lines of four spaces outside of pictures, sections 1 to 5."""
    text = re.sub(r"^```.*?^```", "", text_of("doc/model.md").split("\n## 6.")[0], flags=re.M | re.S)
    known = {*symbols.symbols, *(symbol[:-1] for symbol in symbols.symbols if symbol[-1] in "+-"),  # psi'- is psi' at an instant
             "sin", "cos", "tan", "sgn", "int", "dt", "for", "else", "pi", "x", "y"}
    used = {symbol for line in re.findall(r"^    .*", text, re.M) for symbol in re.findall(r"[A-Za-z][A-Za-z0-9]*'*", line)}
    assert len(used) > 70
    assert [symbol for symbol in used if not {symbol, re.sub(r"^d2?|2$", "", symbol)} & known] == []  # dpsi, dphi2


def test_every_cpp_name_of_the_symbol_table_exists(symbols):
    words = set(re.findall(r"\w+", text_below("src/hammer_loads", ".h")))
    assert len(symbols.cpp) > 50
    assert [name for name in symbols.cpp if not set(re.findall(r"\w+", name)) <= words] == []


def test_every_key_of_the_symbol_table_exists_and_no_hammer_key_is_missing(symbols):
    hammer = parameters_in("hammer_mo100")
    assert {key for key in hammer if "_std" not in key} <= symbols.yaml <= set(hammer) | set(parameters_in("pipeline"))


def test_symbol_table_holds_every_number_of_the_messages_it_names(symbols):
    messages, fields = {name.split(".")[0] for name in symbols.messages}, set()
    assert {"Blow", "PinForces", "Pulse"} <= messages
    for message in messages:
        names = {f"{message}.{field}" for field in re.findall(r"float64 (\w+)", text_of(f"msg/{message}.msg"))}
        fields |= {name for name in names if "_std" not in name or name in symbols.messages}  # std: of a number that has its row
    assert symbols.messages == fields


def test_symbol_table_holds_every_column_of_evaluate(symbols):
    source = text_of("src/hammer_loads/hammer/evaluate.h", "src/hammer_loads/hammer/evaluate.cpp")
    columns = set(re.findall(r'"(\w+_(?:rad|rad_s|rad_s2|m_s2|N|Nm))"', source))
    assert len(columns) == 21
    assert symbols.columns == columns


def test_references_hold_every_work_that_the_documents_cite():
    """A key is a name and a year, or one of the three papers."""
    keys = set(re.findall(r"@\w+\{(\w+),", text_of("doc/references.bib")))
    cited = set(re.findall(r"\b[a-z]{3,}(?:19|20)\d\d\b", text_below("doc", ".md") + text_of("README.md")))
    cited |= set(re.findall(r"@(\w+)", text_of("doc/paper.md")))
    assert len(keys) > 20 and len(cited) > 15
    assert cited <= keys
