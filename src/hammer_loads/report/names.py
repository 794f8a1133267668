"""Names for what the tables know by a hash alone. A database holds no path: names are those of the given files."""
import pathlib
import re

from report.database import FLEET


def stem(path):
    return pathlib.Path(path).stem


def bag_names(database):
    """{bag_id: file name} of a merged file; where two bags share a name, with its folder."""
    bags = database.records("SELECT bag_id, bag FROM bags ORDER BY bag_id")
    short = [stem(row["bag"]) for row in bags]
    return {row["bag_id"]: name if short.count(name) == 1 else str(pathlib.PurePath(row["bag"]).with_suffix(""))
            for row, name in zip(bags, short)}


def recording_of(subject):
    """{run_id: name of the recording}; a file with several runs numbers them."""
    if subject.database.kind == FLEET:
        bags = bag_names(subject.database)
        names = {run["run_id"]: bags.get(run["bag_id"], "?") for run in subject.runs}
    else:
        names = {run["run_id"]: stem(subject.database.path) for run in subject.runs}
    counts, result = {}, {}
    of_name = list(names.values())
    for run_id, name in names.items():
        counts[name] = counts.get(name, 0) + 1
        result[run_id] = f"{name}, run {counts[name]}" if of_name.count(name) > 1 else name
    return result


def without_unit(channel):
    """The unit stands beside it, once: hull_wrench/force_z in kN is read as two units."""
    return re.sub(r"_(N|Nm|Ns|MPa|Pa|m|rad|J)$", "", channel)
