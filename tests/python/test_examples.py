"""The examples run, scripts and the cells of notebooks, and come to what is known."""

import contextlib
import io
import json
import re
import subprocess
import sys
import unittest

import talus
from fixture import SOURCE, InFolder

EXAMPLES = SOURCE / "python" / "examples"


def run_notebook(name):
    """Run the cells of a notebook in one namespace, as Jupyter would; returns the namespace and what was printed."""
    names, said = {}, io.StringIO()
    for number, cell in enumerate(json.loads((EXAMPLES / name).read_text())["cells"]):
        if cell["cell_type"] == "code":
            with contextlib.redirect_stdout(said):
                exec(compile("".join(cell["source"]), f"{name}, cell {number}", "exec"), names)
    return names, said.getvalue()


class Scripts(InFolder):
    def run_script(self, name):
        done = subprocess.run([sys.executable, str(EXAMPLES / name)], capture_output=True, text=True)
        if done.returncode == 77:
            self.skipTest(done.stdout.strip())
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_user_load(self):
        said = self.run_script("user_load.py")
        self.assertLess(float(re.search(r"largest error: ([0-9.]+) %", said).group(1)), 0.2)

    def test_stepping(self):
        said = self.run_script("stepping.py")
        self.assertLess(float(re.search(r"error: ([0-9.]+) %", said).group(1)), 0.5)

    def test_sweep(self):
        said = self.run_script("sweep.py")
        run_out = [float(row.split()[1]) for row in said.splitlines()[1:4]]
        self.assertEqual(run_out, sorted(run_out, reverse=True))
        self.assertEqual(said.count("the front stood at"), 3)

    def test_calibration(self):
        said = self.run_script("calibration.py")
        self.assertAlmostEqual(float(re.search(r"angle of friction: ([0-9.]+)", said).group(1)), 28, delta=0.1)


class Notebooks(InFolder):
    def test_reading(self):
        (column,) = EXAMPLES.glob("column.yaml")
        with open("column.yaml", "w", encoding="utf-8") as out:
            out.write(column.read_text())
        names, said = run_notebook("reading.ipynb")
        self.assertEqual(names["run"].outcome, "done")
        self.assertIn("<History of 201 rows: time [s], step, front [m], height [m], run_out>", said)
        self.assertGreater(names["pressure"].mean(), 0)

    def test_running(self):
        names, said = run_notebook("running.ipynb")
        self.assertLess(abs(names["tip"] / names["slender"] - 1), 0.02)
        self.assertIn("materials.rubber.yung - key 'yung' of materials.rubber is not known - did you mean 'young'?", said)
        tip = float(re.search(r"tip (\S+) most", said).group(1))
        self.assertLess(abs(tip / names["own_weight"] - 1), 0.02)
        self.assertEqual(names["found"].version["ranks"], "2")
        self.assertEqual(names["found"].history.last["tip"], 0)  # the program knows nothing of the body force


if __name__ == "__main__":
    unittest.main()
