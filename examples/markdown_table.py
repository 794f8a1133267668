"""Tables of the documents."""
import math


def table(head, rows):
    """Markdown, one string for each cell; the first column are names."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def below(difference):
    """A power of ten, one to two decades above a difference: the same text on a computer that rounds otherwise."""
    return f"below 1e{math.ceil(math.log10(difference)) + 1:+03d}"


def beside(value, right):
    """A value with its relative error, where that is seen."""
    error = value / right - 1.0
    return f"{value:.1f} ({error:+.0%})" if abs(error) >= 0.005 else f"{value:.1f}"
