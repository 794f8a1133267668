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


WORDS = {
    "pulse/amplitude": "peak force along the tool",
    "pulse/impulse": "impulse of the pulse",
    "pulse/turn_impulse_x": "impulse of a revolution across the tool",
    "pulse/turn_impulse_z": "impulse of a revolution along the tool",
    "blow/energy": "blow energy",
    "blow/restitution": "restitution",
    "hull_wrench/force_x": "force across the tool, Fx",
    "hull_wrench/force_z": "force along the tool, Fz",
    "hull_wrench/torque_y": "moment about the rocker pivot, My",
}
TOPICS = {"joint_loads": "", "section_loads": "section ", "stress": "stress at "}


def in_words(quantity):
    """Words for a channel (topic/field, topic/name/field, stress/NAME) or a figure of the budget."""
    band = re.fullmatch(r"(.*)_below_([0-9.e+-]+)Hz", quantity)
    if band:
        return f"{in_words(band[1])}, below {band[2]} Hz"
    if quantity in WORDS:
        return WORDS[quantity]
    topic, _, rest = quantity.partition("/")
    slope = re.fullmatch(r"equivalent_range_(\d+)", topic)
    if slope:
        return f"damage-equivalent range (slope {slope[1]}) of {in_words(rest)}"
    if topic not in TOPICS:
        return quantity
    name, _, field = rest.partition("/")
    return TOPICS[topic] + name + (", " + field.replace("_", " ") if field else "")
