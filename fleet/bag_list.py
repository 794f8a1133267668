"""Which bags there are: from a list (CSV or YAML) or a folder."""
import csv
import hashlib
import os
import pathlib
import re
from collections import namedtuple

# bag: the first of a recording, later: its other splits; name: of its files below the results, unique
Bag = namedtuple("Bag", "machine bag parameters name later", defaults=((),))


class BadList(Exception):
    """One line that names the list and the row."""


def file_name(machine, bag, parameters):
    """Readable, and another one for another path, machine or set of parameter files."""
    readable = re.sub(r"[^A-Za-z0-9._-]", "_", f"{machine}/{pathlib.Path(bag).name}".replace("/", "-", 1))
    return readable + "-" + hashlib.sha256("\n".join([machine, bag, *parameters]).encode()).hexdigest()[:8]


def page_name(machine):
    """Of the machine's page; another one for another machine."""
    readable = re.sub(r"[^A-Za-z0-9._-]", "_", machine)
    if readable == machine and machine not in ("all", ".", ".."):
        return machine
    return readable + "-" + hashlib.sha256(machine.encode()).hexdigest()[:8]


def made(machine, bag, parameters):
    """Paths are absolute: jobs run elsewhere."""
    bag, parameters = os.path.abspath(bag), tuple(os.path.abspath(p) for p in parameters)
    return Bag(machine, bag, parameters, file_name(machine, bag, parameters))


def from_rows(rows, path):
    folder, bags = os.path.dirname(os.path.abspath(path)), []
    for at, row in enumerate(rows, 1):
        if not isinstance(row, dict) or not row.get("machine") or not row.get("bag"):
            raise BadList(f"{path}: entry {at}: machine and bag must be given")
        parameters = row.get("parameters") or []
        if isinstance(parameters, str):
            parameters = parameters.split(";")
        bags.append(made(str(row["machine"]), os.path.join(folder, row["bag"]),
                         [os.path.join(folder, p.strip()) for p in parameters]))
    return bags


def from_folder(folder):
    """FOLDER/MACHINE/*.bag with the parameters FOLDER/MACHINE/*.yaml; bags in FOLDER itself are one machine's."""
    bags, folder = [], pathlib.Path(folder)
    for place in [folder] + sorted(p for p in folder.iterdir() if p.is_dir()):
        found = sorted(p for p in place.iterdir() if p.name.endswith((".bag", ".bag.active")))
        parameters = sorted(place.glob("*.yaml"))
        bags += [made(place.resolve().name, str(bag), map(str, parameters)) for bag in found]
    return bags


def read_rows(path):
    if str(path).endswith((".yaml", ".yml")):
        import yaml
        with open(path, encoding="utf-8") as file:
            rows = yaml.safe_load(file)
        if not isinstance(rows, list):
            raise BadList(f"{path}: must be a list of machine, bag, parameters")
        return rows
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        if not {"machine", "bag"} <= set(reader.fieldnames or []):
            raise BadList(f"{path}: the first line must name the columns machine,bag,parameters")
        return list(reader)


def read(path):
    """Every bag once, in the order of the list."""
    if not os.path.exists(path):
        raise BadList(f"{path}: does not exist")
    bags = from_folder(path) if os.path.isdir(path) else from_rows(read_rows(path), path)
    if not bags:
        raise BadList(f"{path}: names no bag")
    names = [bag.name for bag in bags]
    twice = sorted({bag.bag for bag in bags if names.count(bag.name) > 1}) if len(set(names)) < len(names) else []
    if twice:
        raise BadList(f"{path}: {twice[0]} is in the list twice")
    return bags


def may_be_split(bag):
    """By its name, as the node's log and rosbag record --split give it: those alone are opened for the question."""
    return re.search(r"_\d+\.bag$", bag) is not None


def joined(bags, recordings):
    """Splits of one recording as one bag. recordings: from paths to a list of lists of them, in order."""
    groups = {}
    for bag in bags:
        groups.setdefault((bag.machine, bag.parameters, os.path.dirname(bag.bag)), []).append(bag)
    later_of, later = {}, set()
    for members in groups.values():
        asked = [bag.bag for bag in members if may_be_split(bag.bag)]
        for first, *rest in recordings(asked) if len(asked) > 1 else ():
            names = {bag.bag: bag.name for bag in members}
            later_of[names[first]] = tuple(rest)
            later.update(names[bag] for bag in rest)
    return [bag._replace(later=later_of.get(bag.name, ())) for bag in bags if bag.name not in later]
