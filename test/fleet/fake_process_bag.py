#!/usr/bin/env python3
"""process_bag --no-bag BAG --params FILE --db OUT without ROS: a bag is a line of text, `SEED SECONDS FIRST_S`, with
`RUN` behind it where it has one (--recordings), or `broken`. By the name report it writes a page without content.

Each call adds a line to calls.txt beside this program, so that a test sees which bags ran.
"""
import hashlib
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
SELF = pathlib.Path(os.path.abspath(__file__)).parent  # where the link is
sys.path.insert(0, str(HERE.parent / "report"))
import sample_database as sample  # noqa: E402  (the path must be set first)


def main(arguments):
    if pathlib.Path(sys.argv[0]).name == "report":
        pathlib.Path(arguments[arguments.index("--html") + 1]).write_text("a page\n")
        return 0
    version_file = SELF / "version.txt"
    version = version_file.read_text().strip() if version_file.exists() else "0.1.0"
    if "--version" in arguments:
        print(f"hammer_loads {version}")
        return 0
    if "--recordings" in arguments:
        runs, numbers = {}, []
        for bag in arguments[arguments.index("--recordings") + 1:]:
            run = (open(bag).read().split() + [bag] * 4)[3] if os.path.isfile(bag) else bag
            runs.setdefault(run, []).append(bag)
        for number, splits in enumerate(runs.values()):
            for bag in sorted(splits, key=lambda name: open(name).read().split()[2:3] if len(splits) > 1 else 0):
                print(number, bag)
        return 0
    begin = arguments.index("--no-bag") + 1
    bags, out = arguments[begin:arguments.index("--db")], arguments[arguments.index("--db") + 1]
    bag = bags[0]
    with open(SELF / "calls.txt", "a") as file:
        file.write("+".join(map(os.path.basename, bags)) + "\n")
    with open(SELF / "options.txt", "w") as file:
        file.write(" ".join(arguments[arguments.index("--db") + 2:]))
    words = open(bag).read().split() if os.path.exists(bag) else []
    if words[:1] in ([], ["broken"]):
        print(f"{bag}: " + ("is no bag, or a damaged one" if words else "cannot be read: No such file"), file=sys.stderr)
        return 1
    parameters = [open(a).read() for b, a in zip(arguments, arguments[1:]) if b == "--params"]
    name = hashlib.sha256("".join(parameters).encode()).hexdigest()[:6]
    sample.make(out, sample.Machine(name, peak_N=40600.0 + 500 * int(words[0])), seconds=float(words[1]),
                first_ns=int(float(words[2]) * 1e9), seed=int(words[0]), boom=False, classes=128)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
