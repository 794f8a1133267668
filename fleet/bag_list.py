"""List of the bags, from a file (CSV or YAML) or a folder."""
import csv
import hashlib
import os
import pathlib
import re
import unicodedata
from collections import namedtuple

# name: of its files below the results, unique. bag: the first of a recording, later: its other splits. problem: why it
# cannot be tried, or nothing.
Bag = namedtuple("Bag", "machine bag parameters name problem later", defaults=("", ()))


class BadList(Exception):
    """One line that names the list and the row."""


def file_name(machine, bag, parameters):
    """Readable, and another one for another path, machine or set of parameter files."""
    readable = re.sub(r"[^A-Za-z0-9._-]", "_", f"{machine}/{pathlib.Path(bag).name}".replace("/", "-", 1))
    return readable + "-" + hashlib.sha256("\n".join([machine, bag, *parameters]).encode()).hexdigest()[:8]


def page_name(machine):
    """File name of the machine's page, unique for each machine."""
    readable = re.sub(r"[^A-Za-z0-9._-]", "_", machine)
    if readable == machine and machine not in ("all", ".", ".."):
        return machine
    return readable + "-" + hashlib.sha256(machine.encode()).hexdigest()[:8]


def shown(name):
    """Fit for tables, pages and terminals, whatever bytes a name has."""
    return "".join("\ufffd" if unicodedata.category(c) in ("Cc", "Cs", "Zl", "Zp") else c for c in name)


def made(machine, bag, parameters, problem=None):
    """Paths are absolute: jobs run elsewhere. One that no job can be given is a row with the reason."""
    bag, parameters = os.path.abspath(bag), tuple(os.path.abspath(p) for p in parameters)
    for text in (machine, bag, *parameters):
        if shown(text) != text and problem is None:
            problem = f"{shown(text)}: holds what is no UTF-8 text, or control characters: give it another name"
    machine, bag, parameters = shown(machine), shown(bag), tuple(map(shown, parameters))
    return Bag(machine, bag, parameters, file_name(machine, bag, parameters), problem)


def from_rows(rows, path):
    folder, bags = os.path.dirname(os.path.abspath(path)), []
    for at, row in enumerate(rows, 1):
        if problem := why_no_entry(row):
            machine = row.get("machine") if isinstance(row, dict) else None
            bags.append(made(str(machine or "no machine named"), f"{path}, entry {at}", [], f"entry {at}: {problem}"))
        else:
            bags.append(made(str(row["machine"]), os.path.join(folder, row["bag"]),
                             [os.path.join(folder, name.strip()) for name in parameters_of(row)]))
    return bags


def parameters_of(row):
    given = row.get("parameters") or []
    return given.split(";") if isinstance(given, str) else given


def why_no_entry(row):
    """Fault of a list's entry, or nothing."""
    if not isinstance(row, dict) or not row.get("machine") or not row.get("bag"):
        return "machine and bag must be given"
    if not isinstance(row["machine"], (str, int)) or not isinstance(row["bag"], str):
        return f"machine and bag: {row['machine']!r}, {row['bag']!r}, must be texts"
    parameters = parameters_of(row)
    if not (isinstance(parameters, list) and all(isinstance(name, str) for name in parameters)):
        return f"parameters: {parameters!r}, must be a list of paths"
    return None


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
        try:
            with open(path, encoding="utf-8") as file:
                rows = yaml.safe_load(file)
        except (yaml.YAMLError, UnicodeError, RecursionError) as error:
            raise BadList(f"{path}: not valid YAML: {' '.join(str(error).split())}")
        if not isinstance(rows, list):
            raise BadList(f"{path}: must be a list of machine, bag, parameters")
        return rows
    with open(path, encoding="utf-8", errors="surrogateescape", newline="") as file:
        reader = csv.DictReader(line.replace("\0", "\x01") for line in file)  # csv ends at the one, not at the other
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
    groups, later_of, later = {}, {}, set()
    for bag in bags:
        if not bag.problem and may_be_split(bag.bag):
            groups.setdefault((bag.machine, bag.parameters, os.path.dirname(bag.bag)), {})[bag.bag] = bag
    for members in groups.values():
        for first, *rest in recordings(list(members)) if len(members) > 1 else ():
            later_of[members[first]] = tuple(rest)
            later.update(members[path] for path in rest)
    return [bag._replace(later=later_of.get(bag, ())) for bag in bags if bag not in later]
