"""Content of a page, read as a browser without JavaScript reads it, against independent queries of the database."""
import sqlite3
import statistics
import unittest

from support import ReportTest, report, value as number
import sample_database as sample


class Page(ReportTest):
    def setUp(self):
        super().setUp()
        self.file = self.directory / "site_a.sqlite"
        self.machine = sample.Machine(parameters={"rocker_mass_kg": ("36.5", "35.2"), "own_key": ("1", None)})
        sample.make(self.file, self.machine, seconds=200.0, restarts=2, refusals={"duplicate": 7, "unsettled": 3},
                    warnings=[("jitter", "crank stamps jitter by 0.23 ms"), ("second", "the less important one")])

    def ask(self, sql):
        db = sqlite3.connect(str(self.file))
        rows = db.execute(sql).fetchall()
        db.close()
        return rows

    def test_warnings_come_first_in_their_order(self):
        page = self.page_of(self.file)
        places = [page.text.index(words) for words in
                  ("crank stamps jitter by 0.23 ms", "the less important one", "Who, when, which parameters")]
        self.assertEqual(places, sorted(places))

    def test_statistics_are_those_of_all_turns(self):
        rows = self.page_of(self.file).table("Over all revolutions")
        peaks = [row[0] / 1000 for row in self.ask("SELECT amplitude FROM turns")]
        shown = rows["Peak force along the tool [kN]"]
        self.assertAlmostEqual(number(shown["Median"]), statistics.median(peaks), delta=1e-3 * max(peaks))
        self.assertAlmostEqual(number(shown["Greatest"]), max(peaks), delta=1e-3 * max(peaks))
        self.assertEqual(number(shown["Values"]), len(peaks))
        # The first blow has no hold-down: it is left out, not zero.
        self.assertEqual(number(rows["Hold-down needed [kN]"]["Values"]), len(peaks) - 1)
        self.assertGreater(number(rows["Hold-down needed [kN]"]["Least"]), 0.1)

    def test_thinned_curves_keep_least_and_greatest(self):
        long_file = self.directory / "long.sqlite"
        sample.make(long_file, seconds=1000.0, boom=False)
        db = sqlite3.connect(str(long_file))
        least, greatest = db.execute("SELECT min(energy), max(energy) FROM blows").fetchone()
        turns = db.execute("SELECT count(*) FROM blows").fetchone()[0]
        db.close()
        band = [point for piece in self.page_of(long_file).drawn("Blow energy:").curves("band first") for point in piece]
        self.assertLess(len(band), turns / 2)  # it is thinned
        self.assertAlmostEqual(min(y for _, y in band), least, delta=1e-3 * greatest)
        self.assertAlmostEqual(max(y for _, y in band), greatest, delta=1e-3 * greatest)

    def test_differing_parameters_are_listed(self):
        rows = self.page_of(self.file).table("Parameters that differ from the shipped ones")
        self.assertEqual(rows, {"rocker_mass_kg": {"In force": "36.5", "Shipped": "35.2"},
                                "own_key": {"In force": "1", "Shipped": "none"}})

    def test_sensor_health_is_shown(self):
        page = self.page_of(self.file)
        health = page.table("The crank's sensor")
        self.assertEqual(health["Consistency"]["Status"], "ok")
        self.assertEqual(health["Restarts"]["Value"], "2")
        self.assertEqual((health["Hull pitch"]["Value"], health["Hull pitch"]["Status"]), ("0.35 rad", "ok"))
        self.assertEqual(health["Refused samples"]["Value"].split()[0], "10")
        self.assertEqual(page.table("Refused samples by reason")["duplicate"]["Samples"], "7")

    def test_loads_of_joints_and_sections_are_shown(self):
        page = self.page_of(self.file)
        rows = page.table("Loads over all revolutions")
        least, mean, greatest = self.ask(
            "SELECT min(t.minimum), avg(mean), max(t.maximum) FROM turn_loads t JOIN channels USING(run_id, channel) "
            "WHERE name = 'section_loads/boom_foot/torque_y'")[0]
        shown = rows["section boom_foot, torque y"]
        for name, value in (("Least", least), ("Mean of revolutions", mean), ("Greatest", greatest)):
            self.assertAlmostEqual(number(shown[name]), value / 1000, delta=1e-3 * abs(greatest) / 1000)
        for kind, count in self.ask("SELECT rtrim(name, replace(name, '/', '')), count(*) FROM channels GROUP BY 1"):
            self.assertEqual(sum(len(p.classes("line")) for p in page.pictures if p.title == kind.rstrip("/")), count, kind)

    def test_turns_are_shown_with_half_sine_and_band(self):
        page = self.page_of(self.file)
        for kind in ("Typical revolution", "Worst revolution"):
            self.assertIn(kind + ", number", page.text)
            for drawn in ("line first", "line second", "line third", "band first"):
                self.assertEqual(len(page.drawn(kind).curves(drawn)), 1, drawn)

    def test_the_typical_turn_is_the_first_picture(self):
        """The curve is that of the table."""
        picture = self.page_of(self.file).pictures[0]
        self.assertTrue(picture.title.startswith("Typical revolution"), picture.title)
        forces = [force / 1000 for force, in self.ask("SELECT force_z FROM traces WHERE kind = 'typical' AND run_id = 1")]
        curve, = picture.curves("line first")
        self.assertAlmostEqual(max(y for _, y in curve), max(forces), delta=2e-3 * max(forces))
        self.assertAlmostEqual(min(y for _, y in curve), min(forces), delta=2e-3 * max(forces))

    def test_the_page_serves_keyboard_and_screen_reader(self):
        page = self.page_of(self.file)
        self.assertEqual(len(page.ids), len(set(page.ids)))
        for link in page.links:
            if link.startswith("#"):
                self.assertIn(link[1:], page.ids)
        self.assertEqual([given.get("class") for tag, given in page.tags if tag == "a"][0], "skip")
        levels = [int(tag[1]) for tag, _ in page.tags if tag in ("h1", "h2", "h3", "h4")]
        self.assertEqual(levels.count(1), 1)
        self.assertTrue(all(b - a <= 1 for a, b in zip(levels, levels[1:])))
        for tag, given in page.tags:
            if tag == "svg" or given.get("class") in ("chart", "scroll"):
                self.assertTrue(given["aria-label"])
            if given.get("class") in ("chart", "scroll"):
                self.assertEqual(given["tabindex"], "0")

    def test_needs_no_network(self):
        for tag, given in self.page_of(self.file).tags:
            for name in ("src", "href", "srcset"):
                self.assertFalse(given.get(name, "#").startswith(("http", "//", "file")), (tag, given))

    def test_equal_files_give_equal_bytes(self):
        pages = []
        for name in ("one.html", "two.html"):
            self.assertEqual(report(self.file, "--html", self.directory / name).returncode, 0)
            pages.append((self.directory / name).read_bytes())
        self.assertEqual(*pages)

    def test_a_long_recording_has_a_small_page(self):
        """Curves are thinned: eight times the turns, hardly more bytes; far below 3 MB with all channels."""
        sizes = []
        for seconds in (150.0, 1200.0):
            file, out = self.directory / f"of_{seconds:.0f}.sqlite", self.directory / f"of_{seconds:.0f}.html"
            sample.make(file, seconds=seconds)
            self.assertEqual(report(file, "--html", out).returncode, 0)
            sizes.append(out.stat().st_size)
        self.assertLess(sizes[1], 1.2 * sizes[0])
        self.assertLess(sizes[1], 1.5e6)


class Comparison(ReportTest):
    def setUp(self):
        super().setUp()
        self.files = []
        for name, peak in (("first", 40000.0), ("second", 60000.0)):
            self.files.append(self.directory / (name + ".sqlite"))
            sample.make(self.files[-1], sample.Machine(name, peak_N=peak), seconds=60.0)

    def test_machines_are_shown_side_by_side_and_overlaid(self):
        page = self.page_of(*self.files)
        peaks = page.table("Machines side by side")["Peak force along the tool [kN]"]
        self.assertAlmostEqual(number(peaks["second"]) / number(peaks["first"]), 1.5, delta=0.05)
        self.assertAlmostEqual(number(peaks["Diff. [%]"]), 50.0, delta=5.0)
        curves = [p for p in page.pictures if p.title.endswith("over the time of work")]
        self.assertEqual([p.classes("line") for p in curves], 5 * [["line first", "line second"]])

    def test_figures_affected_by_a_warning_are_marked(self):
        third, boom = self.directory / "third.sqlite", self.directory / "boom.sqlite"
        sample.make(third, seconds=60.0, warnings=[("jitter", "crank stamps jitter by 0.23 ms")])
        sample.make(boom, seconds=60.0, warnings=[("pressures", "pressures in bar")])
        rows = self.page_of(self.files[0], third, boom).table("Machines side by side")
        marked = {label: {name for name, row in rows.items() if row[label].endswith("?")}
                  for label in ("first", "third", "boom")}
        self.assertEqual(marked["first"], set())
        self.assertIn("Blow energy [J]", marked["third"])
        self.assertNotIn("Blows", marked["third"])
        self.assertEqual({name.split(" at ")[0] for name in marked["boom"]}, {"stress"})

    def test_many_machines_are_rows(self):
        files = []
        for i in range(6):
            files.append(self.directory / f"machine{i}.sqlite")
            sample.make(files[-1], sample.Machine(f"m{i}"), seconds=20.0, boom=False)
        self.assertEqual(len(self.page_of(*files).table("Machines, one a row")), 6)

    def test_files_of_one_name_are_distinguished(self):
        other = self.directory / "other"
        other.mkdir()
        sample.make(other / "first.sqlite", seconds=20.0, boom=False)
        header = self.page_of(self.files[0], other / "first.sqlite").tables["Machines side by side"][0][0]
        self.assertEqual(header[1:], ["first", "first (2)", "Diff. [%]"])

    def test_two_machines_in_one_file_are_never_added(self):
        db = sqlite3.connect(str(self.files[0]))
        db.execute("ATTACH ? AS other", (str(self.files[1]),))
        for table in ("runs", "channels", "cycles", "residues", "turns", "blows"):
            db.execute(f"UPDATE other.{table} SET run_id = 2")
            db.execute(f"INSERT INTO {table} SELECT * FROM other.{table}")
        db.commit()
        db.close()
        note = "first: holds 2 machines (hammer, boom or their parameters differ); each stands alone"
        page = self.page_of(self.files[0], note=note)
        self.assertIn(note, page.text)
        self.assertEqual(page.tables["Machines side by side"][0][0][1:], ["first, machine 1", "first, machine 2", "Diff. [%]"])


class LittleData(ReportTest):
    def test_a_file_without_a_revolution_is_reported(self):
        file = self.directory / "idle.sqlite"
        sample.make(file, seconds=0.0, boom=False)
        page = self.page_of(file, note="idle: no whole revolution")
        self.assertIn("no whole revolution", page.text)
        self.assertIn("The crank's sensor", page.tables)

    def test_a_file_without_a_run_is_reported(self):
        file = self.directory / "nothing.sqlite"
        sample.make(file, runs=0)
        self.assertIn("no run at all", self.page_of(file, note="nothing: no run at all").text)

    def test_a_file_without_a_boom_has_no_sections(self):
        file = self.directory / "bare.sqlite"
        sample.make(file, seconds=20.0, boom=False)
        self.assertIn("No sections", self.page_of(file).text)

    def test_null_columns_are_survived(self):
        file = self.directory / "null.sqlite"
        sample.make(file, seconds=20.0)
        db = sqlite3.connect(str(file))
        for table, kept in (("runs", ("run_id", "run_key", "input_sha256", "parameters_sha256", "machine", "version",
                                      "revision", "parameters_yaml")), ("turns", ("run_id", "turn")),
                            ("blows", ("run_id", "turn")), ("turn_loads", ("run_id", "turn", "channel")),
                            ("traces", ("run_id", "kind", "turn", "place", "time")),
                            ("channels", ("run_id", "channel", "name", "counted", "least", "greatest", "classes"))):
            names = [row[1] for row in db.execute(f"PRAGMA table_info({table})")]
            db.execute(f"UPDATE {table} SET " + ", ".join(f"{n} = NULL" for n in names if n not in kept))
        db.commit()
        db.close()
        self.assertIn("Load cycles", self.page_of(file, note="null: no whole revolution").text)


class Hostile(ReportTest):
    EVIL = "</script><script>alert(1)</script><b onmouseover='x' title=\"y\">&amp;$\\frac{$\x1b[31m\u202e"

    def test_text_of_a_database_stays_text(self):
        file = self.directory / "evil.sqlite"
        sample.make(file, seconds=20.0, warnings=[(self.EVIL, self.EVIL)], refusals={self.EVIL: 3})
        db = sqlite3.connect(str(file))
        for table in ("runs", "parameters", "channels", "traces"):
            for _, name, kind, *_ in db.execute(f"PRAGMA table_info({table})").fetchall():
                if kind == "TEXT" and name not in ("run_key", "kind", "key"):
                    db.execute(f"UPDATE {table} SET {name} = ?", (self.EVIL,))
        db.execute("UPDATE parameters SET shipped = 'other', key = key || ?", (self.EVIL,))
        db.commit()
        db.close()
        page = self.page_of(file)
        plain = self.directory / "plain.sqlite"
        sample.make(plain, seconds=20.0)
        count = lambda reader, name: sum(tag == name for tag, _ in reader.tags)  # noqa: E731
        honest = self.page_of(plain, options=["--force"])
        for name in ("script", "b"):
            self.assertEqual(count(page, name), count(honest, name))
        self.assertFalse([given for _, given in page.tags if "onmouseover" in given])
        self.assertIn("alert(1)", page.text)

    def test_name_of_a_file_stays_text(self):
        file = self.directory / "<img src=x onerror=alert(1)>.sqlite"
        sample.make(file, seconds=20.0, boom=False)
        self.assertFalse([tag for tag, _ in self.page_of(file, file.with_name(file.name)).tags if tag == "img"])


if __name__ == "__main__":
    unittest.main()
