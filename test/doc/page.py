"""A page's own code blocks: the files to write, the commands to run, what these show."""
import re
import typing


class File(typing.NamedTuple):
    """A block of YAML or XML whose first line is a comment with the file's name."""
    name: str
    text: str


class Commands(typing.NamedTuple):
    """A block of sh."""
    lines: typing.List[str]


class Shows(typing.NamedTuple):
    """A block without language: each line is in what the commands before it say."""
    lines: typing.List[str]


class Stop(typing.NamedTuple):
    """Text that asks for Ctrl-C."""


FENCE = re.compile(r"^```(\w*)\n(.*?)^```\n", re.M | re.S)
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])")


def parts_of(page):
    """Parts of the page's text, in its order."""
    parts, last = [], 0
    for block in FENCE.finditer(page):
        if "Ctrl-C" in page[last:block.start()]:
            parts.append(Stop())
        last = block.end()
        language, text = block.groups()
        if language == "sh":
            parts.append(Commands(text.splitlines()))
        elif language:
            parts.append(File(re.search(r"[\w.]+\.\w+", text.splitlines()[0]).group(), text))
        else:
            parts.append(Shows(text.splitlines()))
    return parts


def agrees(shown, said):
    """Returns True if a line of the page is in a line of a command's output: words as they are, `...` for anything, numbers to one
    of the last digit shown."""
    shown, said = " ".join(shown.split()), " ".join(said.split())
    pattern = re.escape(NUMBER.sub("\0", shown)).replace(re.escape("\0"), "\0").replace(re.escape("..."), ".*")
    found = re.search(pattern.replace("\0", r"(-?[\d.]+(?:e[+-]?\d+)?)"), said)
    if not found:
        return False
    for figure, value in zip(NUMBER.findall(shown), found.groups()):
        digits = len(figure.partition(".")[2])
        if abs(float(figure) - float(value)) > 1.001 * 10.0**-digits:
            return False
    return True


def missing(shows, said):
    """Lines of the page that no line of the output agrees with."""
    return [line for line in shows.lines if not any(agrees(line, other) for other in said.splitlines())]
