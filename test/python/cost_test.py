"""Cost of the module (scripts/python_cost). Bounds on time count in the nightly run."""
import os
import subprocess
import sys
import unittest

import support


class Cost(unittest.TestCase):
    def test_a_million_wrenches(self):
        nightly = os.environ.get("HAMMER_LOADS_NIGHTLY")
        environment = dict(os.environ)
        path = [environment.get("HAMMER_LOADS_MODULES"), environment.get("PYTHONPATH")]
        environment["PYTHONPATH"] = os.pathsep.join(filter(None, path))
        text = subprocess.check_output([sys.executable, str(support.SOURCE / "scripts" / "python_cost"), "--states",
                                        "1000000" if nightly else "100000"], env=environment, universal_newlines=True)
        print(text)
        values = dict(line.split(": ") for line in text.splitlines())
        self.assertEqual(len(values), 7)
        if not nightly:
            return
        self.assertLess(float(values["import_s"]), 0.2)
        for level in ("rocker", "linkage"):
            self.assertLess(float(values[level + "_python_s"]), 0.1)
            self.assertLess(float(values[level + "_ratio"]), 2.0)


if __name__ == "__main__":
    unittest.main()
