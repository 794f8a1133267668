"""The example of doc/report.md does what it says."""
import os
import re
import subprocess
import sys
import unittest

from support import SOURCE, ReportTest
import sample_database as sample


class Example(ReportTest):
    def test_ten_lines_make_a_picture(self):
        text = (SOURCE / "doc" / "report.md").read_text(encoding="utf-8")
        code = re.search(r"<!-- example -->\n```python\n(.*?)```", text, re.S).group(1)
        self.assertLessEqual(code.count("\n"), 10)
        sample.make(self.directory / "work.sqlite", seconds=20.0, boom=False)
        subprocess.run([sys.executable, "-c", code], cwd=str(self.directory), check=True,
                       env=dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=str(self.directory)))
        self.assertGreater((self.directory / "work.png").stat().st_size, 5000)


if __name__ == "__main__":
    unittest.main()
