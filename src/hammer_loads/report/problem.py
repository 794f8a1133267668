"""One line for the user when something cannot be done."""


class Problem(Exception):
    """One line that names the file and the reason; the command ends with code 1."""
