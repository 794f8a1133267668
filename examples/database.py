#!/usr/bin/env python3
"""What process_bag --db wrote, as pandas: energy and peak of the blows over time; with --png a picture.

    rosrun hammer_loads process_bag in.bag --no-bag --db out.sqlite
    examples/database.py out.sqlite [--png blows.png]
"""
import argparse

import hammer_loads_py as hl
import pandas


def main(arguments=None):
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("database")
    options.add_argument("--png")
    given = options.parse_args(arguments)

    tables = {name: pandas.DataFrame(columns) for name, columns in hl.read_database(given.database).items()}
    turns = tables["turns"].merge(tables["blows"][["run_id", "turn", "energy", "restitution"]],
                                  on=["run_id", "turn"])
    turns["time"] = (turns["stamp_ns"] - turns["stamp_ns"].min()) / 1e9
    print(turns[["amplitude", "impulse", "period", "energy", "restitution"]].describe().to_string())
    if given.png:
        import matplotlib
        matplotlib.use("Agg")
        axes = turns.plot(x="time", y=["amplitude", "energy"], subplots=True, style=".")
        axes[0].get_figure().savefig(given.png)


if __name__ == "__main__":
    main()
