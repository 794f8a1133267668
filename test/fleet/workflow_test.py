"""The workflow on one machine: what is broken is a row, only what changed runs again."""
import subprocess
import sys

import pytest

from support import execute


def snakemake_version():
    """Version of Snakemake; 0 without it."""
    done = subprocess.run([sys.executable, "-c", "import snakemake; print(snakemake.__version__)"], capture_output=True,
                          text=True)
    return int(done.stdout.split(".")[0]) if done.returncode == 0 else 0


pytestmark = pytest.mark.skipif(snakemake_version() < 7, reason="needs Snakemake 7, as in Debian 12")


@pytest.fixture
def bags(tmp_path):
    folder = tmp_path / "bags"
    for machine, count in (("red", 2), ("blue <b>", 1), ("green", 1)):
        (folder / machine).mkdir(parents=True)
        (folder / machine / "hammer.yaml").write_text(f"hammer: {machine}\n")
        for i in range(count):
            (folder / machine / f"{machine[0]}{i}.bag").write_text(f"{i} 20 {1700000000 + 100 * i}")
    return folder


def test_broken_bags_are_rows_and_only_changes_run(fleet, bags):
    (bags / "red" / "r_broken.bag").write_text("broken")
    (bags / "red" / "r_now.bag.active").write_text("0 20 0")
    last = fleet.run(bags).rstrip().rsplit("\n", 1)[-1]
    assert last.startswith("fleet: 6 bags, 2 failed (") and "r_broken.bag: " in last
    everything = ["b0.bag", "g0.bag", "r0.bag", "r1.bag", "r_broken.bag"]
    assert fleet.calls() == everything
    rows = fleet.bags()
    assert [name for name, row in sorted(rows.items()) if row[0] == "done"] == everything[:-1]
    assert "is no bag" in rows["r_broken.bag"][1]
    assert "still being written" in rows["r_now.bag.active"][1]
    pages = {path.name: path.stat().st_mtime_ns for path in (fleet.out / "pages").iterdir()}
    assert len(pages) == 4 and "all.html" in pages

    (bags / "red" / "r1.bag").write_text("7 20 1700000100")
    (bags / "red" / "r_broken.bag").write_text("5 20 1700000900")
    (bags / "green" / "hammer.yaml").write_text("hammer: green, new rocker\n")
    fleet.run(bags)
    assert fleet.calls() == ["g0.bag", "r1.bag", "r_broken.bag"]
    assert fleet.bags()["r_broken.bag"] == ("done", None)
    assert sorted(path.name[:3] for path in (fleet.out / "pages").iterdir() if path.stat().st_mtime_ns > pages[path.name]) == [
        "all", "gre", "red"]

    (fleet.programs / "version.txt").write_text("0.2.0")
    fleet.run(bags)
    assert fleet.calls() == everything


def test_splits_and_topics_reach_process_bag(fleet, tmp_path):
    folder = tmp_path / "splits"
    folder.mkdir()
    (folder / "w_1.bag").write_text("3 20 1700000020 run1")
    (folder / "w_0.bag").write_text("3 20 1700000000 run1")
    (folder / "w_2.bag").write_text("4 20 1700000090 run2")
    fleet.run(folder, ["crank_topic=/drive/encoder", "imu_topic=/imu"])
    assert fleet.calls() == ["w_0.bag+w_1.bag", "w_2.bag"]
    assert (fleet.programs / "options.txt").read_text().split() == ["--crank-topic", "/drive/encoder", "--imu-topic", "/imu"]
    assert sorted(fleet.bags()) == ["w_0.bag", "w_2.bag"]


def test_a_list_with_rows_of_turns_is_merged_and_has_pages(fleet, bags, tmp_path):
    listed = tmp_path / "list.csv"
    listed.write_text("machine,bag,parameters\nred,bags/red/r0.bag,bags/red/hammer.yaml\ngreen,bags/red/none.bag,\n")
    fleet.use_real_report()
    fleet.run(listed, ["rows=turns"])
    assert fleet.bags() == {"r0.bag": ("done", None), "none.bag": ("failed", "does not exist")}
    assert execute(fleet.out / "merged.sqlite", "SELECT count(*) FROM turns") == [(100,)]
    for name in ("all", "red", "green"):
        assert "Loads of the hammer" in (fleet.out / "pages" / f"{name}.html").read_text()


def test_odd_names_end_nothing(fleet, bags, tmp_path):
    """Each is a row: processed, or with the reason; programs may lie in a folder with a space."""
    fleet.programs = fleet.programs.rename(tmp_path / "pro grams")
    for name in ("{x}.bag", "-x.bag", "a b.bag", "'q'{z}.bag"):
        (bags / "red" / name).write_text(f"{len(name)} 20 {1700001000 + 100 * ord(name[0])}")
    listed = tmp_path / "list.yaml"
    listed.write_text("- {machine: red, bag: bags/red/r0.bag}\n- {machine: '{y}', bag: 'bags/red/{x}.bag'}\n"
                      "- {machine: -m, bag: bags/red/-x.bag}\n- {machine: red, bag: 'bags/red/a b.bag'}\n"
                      "- {machine: red, bag: \"bags/red/'q'{z}.bag\"}\n- {machine: red, bag: 5}\n"
                      '- {machine: red, bag: bags/red/r1.bag, parameters: ["h\\0.yaml"]}\n')
    fleet.run(listed)
    rows = fleet.bags()
    assert sorted(name for name, row in rows.items() if row[0] == "done") == ["'q'{z}.bag", "-x.bag", "a b.bag", "r0.bag", "{x}.bag"]
    assert "control characters" in rows["r1.bag"][1]
    assert "entry 6: machine and bag: 'red', 5, must be texts" in [row[1] for row in rows.values()]


def test_a_bad_list_is_one_line(fleet, tmp_path):
    done = fleet.snakemake(tmp_path / "none.csv")
    assert done.returncode != 0
    assert "fleet: " in done.stdout and "none.csv: does not exist" in done.stdout
    assert "Traceback" not in done.stdout
