"""Results are read without the C library and MPI: every number as the files have it, while the run goes on, and with
an answer where there is none."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

import talus
from fixture import BLOCK, SOURCE, InFolder
from fixture import talus as program

WALLS = SOURCE / "cases" / "incline" / "case.yaml"


class Runs(InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        program("run", BLOCK, "--out", "block", "--set", "output.every={steps: 2}", "--quiet")

    def test_a_copy_of_the_package_reads_results(self):
        """Away from the sources its version is unknown, and what needs the library says so."""
        shutil.copytree(SOURCE / "python", "copy/python", ignore=shutil.ignore_patterns("__pycache__"))
        script = ("import talus; print(talus.__version__, len(talus.open('block').history['top']), "
                  "len(talus.open('block').states))\n"
                  "try: talus.fields()\nexcept talus.LibraryError as error: print(error)")
        environment = dict(os.environ, PYTHONPATH="copy/python")
        for others in (None, "project(another VERSION 3.0)\n"):  # and in the folder of another project
            if others:
                Path("copy/CMakeLists.txt").write_text(others)
            done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True)
            self.assertEqual(done.stderr, "")
            numbers, error = done.stdout.splitlines()
            rows, states = len(talus.open("block").history["top"]), len(talus.open("block").states)
            self.assertEqual(numbers, f"unknown {rows} {states}")
            self.assertIn("talus.h is neither in", error)

    def test_history_is_that_of_the_file(self):
        history = talus.open("block").history
        lines = Path("block/history.csv").read_text().splitlines()
        self.assertEqual(list(history), ["time", "step", "top", "falling", "mass"])
        self.assertEqual(history.units, {"time": "s", "step": "", "top": "m", "falling": "m/s", "mass": "kg"})
        for row, line in enumerate(lines[1:]):
            self.assertEqual([history[name][row] for name in history], [float(cell) for cell in line.split(",")])
        self.assertEqual(len(history["top"]), len(lines) - 1)
        with self.assertRaisesRegex(KeyError, "no column 'botom'; there are: time, step, top"):
            history["botom"]

    def test_states(self):
        states = talus.open("block").states
        np.testing.assert_allclose(states.times, [0, 0.004, 0.008, 0.01], rtol=1e-12)
        points, grid = states[-1].points, states[-1].grid
        with h5py.File("block/points_000003.hdf") as f:
            np.testing.assert_array_equal(points["displacement"], f["VTKHDF/PointData/displacement"])
        self.assertEqual(grid.cells.shape, (64, 4))
        corners = grid["position"][grid.cells]
        np.testing.assert_allclose(np.ptp(corners, axis=1), np.broadcast_to([0.25, 0.25, 0], (64, 3)), atol=1e-14)
        # free fall until news comes from the floor: the top of the block, where t is 0.01 s
        top = points["position"][:, 1] > 0.9
        np.testing.assert_allclose(points["displacement"][top, 1], -0.5 * 9.81 * 0.01**2, rtol=0.03)
        with self.assertRaisesRegex(KeyError, "no field 'stress'; there are: position, displacement, id"):
            points["stress"]
        with self.assertRaisesRegex(talus.TalusError, "this state has no walls"):
            states[0].walls

    def test_points_keep_their_numbers(self):
        first, last = talus.open("block").states[0].points, talus.open("block").states[-1].points
        moved = last.by_id("displacement") - first.by_id("displacement")
        np.testing.assert_allclose(last.by_id("position") - first.by_id("position"), moved, atol=1e-14)

    def test_a_grid_of_two_ranks(self):
        env = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        subprocess.run(["mpiexec", "--oversubscribe", "-n", "2", os.environ["TALUS_PROGRAM"], "run", str(BLOCK), "--out", "two",
                        "--quiet"], check=True, env=env)
        one, two = (talus.open(name).states[-1] for name in ("block", "two"))
        squares = two.grid["position"][two.grid.cells]
        self.assertEqual(len(np.unique(squares.mean(axis=1).round(9), axis=0)), 64)
        np.testing.assert_allclose(two.points.by_id("displacement"), one.points.by_id("displacement"), atol=1e-12)

    def test_case_log_summary(self):
        run = talus.open("block")
        self.assertEqual(run.case["bodies"][0]["shape"]["box"]["max"], [1.25, 1])
        self.assertEqual(run.case["analysis"]["type"], "dynamic")
        self.assertIn("steps = 5 iterations = ", run.log)
        self.assertEqual((run.summary["steps"], run.summary["outcome"], run.outcome, run.reason), (5, "done", "done", ""))
        self.assertEqual(run.version["talus"], talus.__version__)
        with self.assertRaisesRegex(talus.TalusError, "not for a factor of safety"):
            run.factor

    def test_walls_and_contact(self):
        program("run", WALLS, "--out", "incline", "--quiet", "--set", "analysis.end=0.005")
        state = talus.open("incline").states[-1]
        self.assertEqual((state.walls.cells.shape[1], state.contact.units["pressure"]), (2, "Pa"))
        way = state.walls["position"][state.walls.cells]  # pieces of the plane through (1, 0.7)
        np.testing.assert_allclose((way - [1, 0.7, 0]) @ [-0.292371705, 0.956304756, 0], 0, atol=1e-9)
        self.assertGreater(state.contact["pressure"].max(), 0)

    def test_nothing_of_c_is_loaded(self):
        code = ("import talus; run = talus.open('block'); run.history; run.states[-1].points['displacement']; run.case\n"
                "loaded = open('/proc/self/maps').read()\n"
                "assert 'libtalus' not in loaded and 'libmpi' not in loaded\n"
                "try: talus.Case({}).check()\n"
                "except talus.LibraryError as error: print(error)")
        env = dict(os.environ, TALUS_LIBRARY="/nowhere/libtalus.so")
        said = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True, check=True)
        self.assertIn("TALUS_LIBRARY=/nowhere/libtalus.so", said.stdout)

    def test_no_results(self):
        Path("empty").mkdir(exist_ok=True)
        for path, words in (("empty", "there are no results here"), (SOURCE / "cases" / "cantilever", "talus.Case reads that"),
                            (BLOCK, "this is a file")):
            with self.assertRaisesRegex(talus.TalusError, words):
                talus.open(path)


class RunsAtWork(InFolder):
    def test_a_run_that_is_still_going(self):
        process = subprocess.Popen([os.environ["TALUS_PROGRAM"], "run", str(BLOCK), "--out", "long", "--quiet",
                                    "--set", "analysis.end=1e3", "--set", "output.every={steps: 2}"])
        try:
            seen = []
            while len(seen) < 3 and process.poll() is None:
                time.sleep(0.02)
                if not Path("long/points.hdf.series").is_file():
                    continue
                run = talus.open("long")
                rows, states = len(run.history["top"]), run.states
                self.assertEqual(run.outcome, "running")
                self.assertEqual(states[-1].points["displacement"].shape, (64, 3))
                if not seen or rows > seen[-1]:
                    seen.append(rows)
            self.assertEqual(len(seen), 3)
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait()
        self.assertEqual(talus.open("long").outcome, "interrupted")
        self.assertIn("by a signal, after step", talus.open("long").reason)
        os.unlink("long/timings.txt")
        self.assertEqual(talus.open("long").outcome, "cut off")

    def test_a_row_that_is_half_written(self):
        Path("half").mkdir()
        for name, text in (("case.yaml", "method: mpm\n"), ("version.txt", "talus = 0.2.0\n"),
                           ("history.csv", "time [s],step,tip [m]\n0,0,\n0.5,1,0.25\n1,2,0.")):
            Path("half", name).write_text(text)
        history = talus.open("half").history
        self.assertEqual(list(history.time), [0, 0.5])
        self.assertTrue(np.isnan(history["tip"][0]) and history["tip"][1] == 0.25)
        self.assertEqual(len(talus.open("half").states), 0)


class Tables(InFolder):
    def test_sweep(self):
        program("sweep", BLOCK, "--over", "materials.rubber.young=1e6,2e6", "--measure", "top:min", "--out", "sweep", "--keep")
        sweep = talus.open("sweep")
        self.assertEqual(sweep.table.units["top min"], "m")
        for row, run in enumerate(sweep.runs):
            self.assertEqual(run.case["materials"]["rubber"]["young"], sweep.table["materials.rubber.young"][row])
            self.assertEqual(run.history["top"].min(), sweep.table["top min"][row])

    def test_calibration(self):
        Path("cal").mkdir()
        for name, text in (("runs.csv", "E [Pa],top [um],ended\n1e6,74,done\n2e6,,gave up\n"),
                           ("region.csv", "E [Pa],top [um],+- [um]\n1e6,74,0.5\n"), ("report.md", "# A block\n")):
            Path("cal", name).write_text(text)
        found = talus.open("cal")
        self.assertIsInstance(found, talus.Calibration)
        self.assertEqual(list(found.runs["ended"]), ["done", "gave up"])
        self.assertTrue(np.isnan(found.runs["top"][1]))
        self.assertEqual((found.region["top +-"][0], found.region.units["top +-"]), (0.5, "um"))
        self.assertEqual(found.report, "# A block\n")

    def test_series_names_are_json(self):
        Path("s").mkdir()
        Path("s/points.hdf.series").write_text(json.dumps({"files": [{"name": "points_000000.hdf", "time": 0.5}]}))
        self.assertEqual(talus.States("s").at(2).time, 0.5)


if __name__ == "__main__":
    unittest.main()
