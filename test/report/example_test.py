"""The example of doc/report.md does what it says."""
import os
import re
import subprocess
import sys

from support import SOURCE


def test_ten_lines_make_a_picture(made, tmp_path):
    text = (SOURCE / "doc" / "report.md").read_text(encoding="utf-8")
    code = re.search(r"<!-- example -->\n```python\n(.*?)```", text, re.S).group(1)
    assert code.count("\n") <= 10
    made("work")
    subprocess.run([sys.executable, "-c", code], cwd=str(tmp_path), check=True,
                   env=dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=str(tmp_path)))
    assert (tmp_path / "work.png").stat().st_size > 5000
