"""Bad input and outputs that must stay: one line each, nothing replaced."""
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import unittest
from unittest import mock

from support import REPORT, SOURCE, ReportTest, report
import sample_database as sample


class Inputs(ReportTest):
    def refused(self, file, *words):
        out = self.directory / "out.html"
        self.assertRefused(report(file, "--html", out, "--csv", self.directory / "csv"), file, *words)
        self.assertEqual(sorted(os.listdir(self.directory)), self.before)

    def setUp(self):
        super().setUp()
        self.file = self.directory / "in.sqlite"
        sample.make(self.file, seconds=10.0, boom=False)
        self.before = sorted(os.listdir(self.directory))

    def change(self, sql):
        db = sqlite3.connect(str(self.file))
        db.execute(sql)
        db.commit()
        db.close()

    def test_a_good_file_is_accepted(self):
        self.assertEqual(report(self.file, "--html", self.directory / "out.html").returncode, 0)

    def test_a_missing_file_is_refused(self):
        self.refused(self.directory / "none.sqlite", "No such file")

    def test_a_file_that_is_no_sqlite_is_refused(self):
        for content in (b"", b"#ROSBAG V2.0\n", b"SQLite format 2\0" * 100):
            self.file.write_bytes(content)
            self.refused(self.file, "is no SQLite file")

    def test_half_a_file_is_refused(self):
        content = self.file.read_bytes()
        self.file.write_bytes(content[:len(content) // 2 // 4096 * 4096])
        self.refused(self.file, "cannot be read")

    def test_a_database_of_another_application_is_refused(self):
        self.change("PRAGMA application_id = 1")
        self.refused(self.file, "another database")

    def test_older_and_newer_versions_are_refused(self):
        for version, word in ((0, "older"), (2, "newer")):
            self.change(f"PRAGMA user_version = {version}")
            self.refused(self.file, word, f"version, {version};", "reads version 1")

    def test_a_table_is_missing(self):
        self.change("DROP TABLE cycles")
        self.refused(self.file, "no such table: cycles")

    def test_a_directory_and_a_fifo_are_refused(self):
        fifo = self.directory / "fifo"
        os.mkfifo(fifo)
        self.before = sorted(os.listdir(self.directory))
        self.refused(fifo, "is no regular file")
        self.refused(self.directory, "is no regular file")


class Outputs(ReportTest):
    def setUp(self):
        super().setUp()
        self.file = self.directory / "in.sqlite"
        sample.make(self.file, seconds=10.0, boom=False)
        self.out = self.directory / "out.html"

    def test_replaced_only_with_force_and_only_its_own(self):
        self.assertEqual(report(self.file, "--html", self.out).returncode, 0)
        first = self.out.read_bytes()
        self.assertRefused(report(self.file, "--html", self.out), self.out, "exists already", "--force")
        self.assertEqual(report(self.file, self.file, "--html", self.out, "--force").returncode, 0)
        self.assertNotEqual(self.out.read_bytes(), first)
        self.out.write_text("<html>thesis</html>")
        self.assertRefused(report(self.file, "--html", self.out, "--force"), self.out, "no page of this command")
        self.assertEqual(self.out.read_text(), "<html>thesis</html>")

    def test_an_input_is_never_overwritten(self):
        before = self.file.read_bytes()
        link = self.directory / "link"
        os.link(self.file, link)
        for out in (self.file, link):
            self.assertRefused(report(self.file, "--html", out, "--force"), out, "is the input")
        self.assertEqual(self.file.read_bytes(), before)

    def test_only_regular_files(self):
        fifo, link, folder = (self.directory / name for name in ("fifo", "link", "folder"))
        os.mkfifo(fifo)
        link.symlink_to(self.out)
        folder.mkdir()
        for out in (fifo, link, folder, "/dev/null"):
            self.assertRefused(report(self.file, "--html", out, "--force"), out, "is no regular file")

    def test_a_missing_directory_is_reported(self):
        self.assertRefused(report(self.file, "--html", self.directory / "none" / "out.html"), "No such file")

    def test_an_interruption_leaves_nothing(self):
        """By a signal while it waits for a ledger that is locked."""
        locked = sqlite3.connect(str(self.file), isolation_level=None)
        locked.execute("BEGIN EXCLUSIVE")
        running = subprocess.Popen([sys.executable, str(REPORT), str(self.file), "--html", str(self.out)],
                                   stderr=subprocess.PIPE, stdout=subprocess.PIPE, universal_newlines=True)
        running.send_signal(signal.SIGTERM)
        _, err = running.communicate(timeout=30)
        locked.close()
        self.assertIn(running.returncode, (130, -signal.SIGTERM))  # the latter before Python has begun
        self.assertNotIn("Traceback", err)
        self.assertEqual(os.listdir(self.directory), ["in.sqlite"])


class Usage(ReportTest):
    def test_wrong_usage_is_refused(self):
        for arguments in ((), ("a.sqlite",), ("--html", "x.html"), ("a.sqlite", "--html", "x", "--colour")):
            self.assertRefused(report(*arguments), "report: ", "--help", code=2)

    def test_a_missing_python_package_is_named(self):
        file = self.directory / "in.sqlite"
        sample.make(file, seconds=5.0, boom=False)
        for package in ("pandas", "jinja2", "matplotlib"):
            broken = self.directory / package
            broken.mkdir()
            (broken / "__init__.py").write_text(f"raise ImportError('No module named {package}')\n")
            with mock.patch.dict(os.environ, PYTHONPATH=str(self.directory)):
                self.assertRefused(report(file, "--html", self.directory / "x.html"), f"No module named {package}")
            shutil.rmtree(broken)

    def test_help_and_version_are_printed(self):
        self.assertIn("--html OUT.html", report("--help").stdout)
        version = (SOURCE / "package.xml").read_text().split("<version>")[1].split("<")[0]
        self.assertEqual(report("--version").stdout, f"hammer_loads {version}\n")


if __name__ == "__main__":
    unittest.main()
