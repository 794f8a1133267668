"""List of the bags, from a file (CSV or YAML) or a folder."""
import csv
import hashlib
import os
import pathlib
import re
import unicodedata
from collections import Counter, namedtuple

from report.database import Problem

# name: of its files below the results, unique. bag: the first of a recording, later: its other splits. problem: why it
# cannot be tried, or nothing.
Bag = namedtuple("Bag", "machine bag parameters name problem later", defaults=("", ()))


def file_name(words, *texts):
    """Readable name of a file, and another one for other texts."""
    return re.sub(r"[^A-Za-z0-9._-]", "_", words) + "-" + hashlib.sha256("\n".join(texts).encode()).hexdigest()[:8]


def page_name(machine):
    """File name of the machine's page, unique for each machine."""
    is_fit = re.fullmatch(r"[A-Za-z0-9._-]+", machine) and machine not in ("all", ".", "..")
    return machine if is_fit else file_name(machine, machine)


def shown(name):
    """Fit for tables, pages and terminals, whatever bytes a name has."""
    return "".join("\ufffd" if unicodedata.category(c) in ("Cc", "Cs", "Zl", "Zp") else c for c in name)


def made(machine, bag, parameters, problem=None):
    """Paths are absolute: jobs run elsewhere. One that no job can be given is a row with the reason."""
    given = [machine, *map(os.path.abspath, [bag, *parameters])]
    machine, bag, *parameters = fit = list(map(shown, given))
    if problem is None and fit != given:
        named = next(text for text, name in zip(fit, given) if text != name)
        problem = f"{named}: holds what is no UTF-8 text, or control characters: give it another name"
    name = file_name(f"{machine}-{os.path.basename(bag)}", machine, bag, *parameters)
    return Bag(machine, bag, tuple(parameters), name, problem)


def from_rows(rows, path):
    bags = []
    for at, row in enumerate(rows, 1):
        try:
            bags.append(from_row(row, os.path.dirname(os.path.abspath(path))))
        except ValueError as fault:
            machine = row.get("machine") if isinstance(row, dict) else None
            bags.append(made(str(machine or "no machine named"), f"{path}, entry {at}", [], f"entry {at}: {fault}"))
    return bags


def from_row(row, folder):
    if not isinstance(row, dict) or not row.get("machine") or not row.get("bag"):
        raise ValueError("machine and bag must be given")
    if not isinstance(row["machine"], (str, int)) or not isinstance(row["bag"], str):
        raise ValueError(f"machine and bag: {row['machine']!r}, {row['bag']!r}, must be texts")
    given = row.get("parameters") or []
    parameters = given.split(";") if isinstance(given, str) else given
    if not (isinstance(parameters, list) and all(isinstance(name, str) for name in parameters)):
        raise ValueError(f"parameters: {parameters!r}, must be a list of paths")
    return made(str(row["machine"]), os.path.join(folder, row["bag"]),
                [os.path.join(folder, name.strip()) for name in parameters])


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
            raise Problem(f"{path}: not valid YAML: {' '.join(str(error).split())}")
        if not isinstance(rows, list):
            raise Problem(f"{path}: must be a list of machine, bag, parameters")
        return rows
    with open(path, encoding="utf-8", errors="surrogateescape", newline="") as file:
        reader = csv.DictReader(line.replace("\0", "\x01") for line in file)  # csv ends at the one, not at the other
        if not {"machine", "bag"} <= set(reader.fieldnames or []):
            raise Problem(f"{path}: the first line must name the columns machine,bag,parameters")
        return list(reader)


def read(path):
    """Every bag once, in the order of the list."""
    if not os.path.exists(path):
        raise Problem(f"{path}: does not exist")
    bags = from_folder(path) if os.path.isdir(path) else from_rows(read_rows(path), path)
    if not bags:
        raise Problem(f"{path}: names no bag")
    count = Counter(bag.name for bag in bags)
    if twice := [bag.bag for bag in bags if count[bag.name] > 1]:
        raise Problem(f"{path}: {min(twice)} is in the list twice")
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
