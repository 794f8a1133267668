"""One line for the user when something cannot be done."""


import unicodedata


def one_line(text):
    """No line breaks, no codes that a terminal obeys."""
    return "".join("\ufffd" if unicodedata.category(c) in ("Cc", "Cf", "Cs", "Zl", "Zp") else c for c in str(text))


class Problem(Exception):
    """One line that names the file and the reason; the command ends with code 1."""

    def __str__(self):
        return one_line(super().__str__())
