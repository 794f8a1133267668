"""The command check: what a stranger's first recording has wrong is named, and a sound one passes."""
import json
import math
import subprocess
import unittest

from support import HERE, REPORT, ReportTest, program

from report import checks

SOUND = HERE.parent / "data" / "mo100_1khz.bag"


@unittest.skipUnless(program("process_bag"), "needs the built commands")
class Check(ReportTest):
    def check(self, *arguments):
        link = self.directory / "check"
        if not link.exists():
            link.symlink_to(REPORT)
        return subprocess.run([str(link), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")

    def altered(self, name, change):
        """The sound recording with change(position, velocity) at each crank sample."""
        import rosbag
        path = self.directory / f"{name}.bag"
        with rosbag.Bag(str(SOUND)) as source, rosbag.Bag(str(path), "w") as target:
            for topic, message, time in source.read_messages():
                if topic == "/hammer/crank" and message.position:
                    position, velocity = change(message.position[0], message.velocity[0] if message.velocity else None)
                    message.position, message.velocity = [position], [] if velocity is None else [velocity]
                target.write(topic, message, time)
        return path

    def statuses(self, bag, code):
        outcome = self.check(bag, "--json")
        self.assertEqual(outcome.returncode, code, outcome.stdout + outcome.stderr)
        recording, = json.loads(outcome.stdout)["recordings"]
        return recording["verdict"], {line["check"]: line["status"] for line in recording["checks"]}

    def test_sound_recording_has_no_line_that_is_wrong(self):
        verdict, statuses = self.statuses(SOUND, 0)
        self.assertEqual(statuses["unit"], "ok")
        self.assertEqual(statuses["blows"], "ok")
        self.assertEqual(statuses["consistency"], "ok")
        self.assertGreaterEqual(len(statuses), 10)
        self.assertTrue(verdict.startswith("usable"), verdict)

    def test_text_fits_one_screen_and_states_the_action(self):
        outcome = self.check(self.altered("deg", lambda p, v: (math.degrees(p), math.degrees(v))))
        self.assertEqual(outcome.returncode, 1)
        self.assertLessEqual(len(outcome.stdout.splitlines()), 14)
        self.assertIn("wrong unit", outcome.stdout)
        self.assertIn("radians", outcome.stdout)

    def test_wrong_unit_and_direction_are_wrong(self):
        self.assertEqual(self.statuses(self.altered("rev", lambda p, v: (p / (2 * math.pi), v / (2 * math.pi))), 1)[1]["unit"], "wrong")
        self.assertEqual(self.statuses(self.altered("back", lambda p, v: (-p, -v)), 1)[1]["direction"], "wrong")

    def test_zero_five_degrees_off_is_looked_at(self):
        outcome = self.check(self.altered("zero", lambda p, v: (p + math.radians(5.0), v)), "--json")
        statuses = {line["check"]: line["status"] for line in json.loads(outcome.stdout)["recordings"][0]["checks"]}
        self.assertIn(statuses["zero"], ("look", "wrong"))

    def test_every_key_is_one_that_the_programs_give(self):
        source = "".join(path.read_text() for path in (HERE.parent.parent / "src").rglob("*.[ch]*") if path.suffix in (".cpp", ".h"))
        self.assertEqual([key for key in checks.BY_KEY if f'"{key}"' not in source], [])

    def test_wrong_usage_is_refused(self):
        self.assertEqual(self.check("a.sqlite").returncode, 2)
        self.assertEqual(self.check(self.directory / "no.bag").returncode, 1)


if __name__ == "__main__":
    unittest.main()
