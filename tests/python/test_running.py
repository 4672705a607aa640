"""Cases built, changed, run and stepped from Python, beside what the C library and the program give."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest
import warnings
from pathlib import Path

import numpy as np

import talus
from fixture import BLOCK, SOURCE, InFolder
from fixture import talus as program
from talus import _yaml
from talus._header import Header, find_header
from talus._library import library


def block(**changes):
    """The block of the C library's tests as a dict, with changes by path."""
    case = talus.Case(talus.Case(BLOCK).resolved())
    for path, value in changes.items():
        case[path] = value
    return case


class Interface(unittest.TestCase):
    def test_every_declaration_of_the_header_is_known(self):
        text = find_header().read_text()
        header = Header(text)
        symbols = subprocess.run(["nm", "-D", "--defined-only", library()._dll._name], capture_output=True, text=True)
        exported = {line.split()[-1] for line in symbols.stdout.splitlines()}
        code = re.sub(r"//.*|/\*.*?\*/", "", text, flags=re.S)
        self.assertEqual(set(header.functions), set(re.findall(r"\b([Tt]alus\w*)\(", code)))
        self.assertLessEqual(set(header.functions), exported)
        for name, (_, arguments) in header.functions.items():
            self.assertNotIn(None, arguments, name)
        self.assertEqual(set(header.callbacks), {"TalusBodyForce", "TalusBodyForces", "TalusLoadFactors", "TalusProgress"})

    def test_a_declaration_that_is_not_understood_is_told(self):
        with self.assertRaises(KeyError):
            Header("int TalusNew(quad *x);")

    def test_versions_agree(self):
        self.assertIn(f"VERSION {talus.__version__} ", (SOURCE / "CMakeLists.txt").read_text())
        self.assertEqual(library().text("TalusVersion"), talus.__version__)
        self.assertIn(talus.__version__, subprocess.run([talus.find_program(), "--version"], capture_output=True, text=True).stdout)

    def test_fields_are_those_of_the_program(self):
        listed = subprocess.run([talus.find_program(), "list", "fields"], capture_output=True, text=True).stdout
        for name in talus.fields():
            self.assertIn(f"{name} ", listed)


class Cases(InFolder):
    def test_resolved_cases_come_back(self):
        """Of every case of the sources: as a dict it is the same case again."""
        for file in sorted((SOURCE / "cases").glob("*/case.yaml")):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                case = talus.Case(file)
                first = case.resolved()
                again = talus.Case(first, folder=file.parent)
                self.assertEqual(again.resolved(), first, file)
                with case.opened() as a, again.opened() as b:
                    self.assertEqual(case._resolved_text(a), again._resolved_text(b), file)

    def test_mistakes_of_a_dict_have_their_key(self):
        case = block()
        case["materials.rubber.yung"] = 1e6
        case["bodies[0].points_per_cell"] = -4
        case["bodies[0].material"] = "ruber"
        with self.assertRaises(talus.CaseError) as caught:
            case.check()
        found = {mistake.key: mistake for mistake in caught.exception.mistakes}
        self.assertEqual(set(found), {"materials.rubber.yung", "bodies[0].points_per_cell", "bodies[0].material"})
        self.assertEqual(found["materials.rubber.yung"].hint, "did you mean 'young'?")
        self.assertIn('"yung": 1000000.0', str(caught.exception))

    def test_mistakes_of_a_file_have_their_place(self):
        Path("bad.yaml").write_text(BLOCK.read_text().replace("density", "densty"))
        lines = Path("bad.yaml").read_text().splitlines()
        line = [number for number, text in enumerate(lines, 1) if "densty" in text][0]
        with self.assertRaises(talus.CaseError) as caught:
            talus.Case("bad.yaml").check()
        unknown = [mistake for mistake in caught.exception.mistakes if "densty" in mistake.text][0]
        self.assertEqual((unknown.file, unknown.line, unknown.column), ("bad.yaml", line, lines[line - 1].index("densty") + 1))
        with self.assertRaisesRegex(talus.CaseError, "no such file"):
            talus.Case("nothing.yaml").check()
        case = block(**{"grid.box.min": [5, -0.5], "grid.box.max": [7, 1.5]})
        with self.assertRaisesRegex(talus.CaseError, "block") as caught:  # shows only when the grid is there
            case.run("nowhere")
        self.assertFalse(Path("nowhere").exists())

    def test_warnings_are_of_the_line_that_led_there(self):
        case = block(**{"grid.counts": [16, 16], "bodies[0].shape.box.max": [1.2, 1], "bodies[0].fill": "cells"})
        for act in (lambda: case.model().close(), lambda: case.run("coarse"), lambda: talus.run(case, "coarse-too")):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                act()
            self.assertEqual({warning.filename for warning in caught}, {__file__})
            self.assertIn("whole cells represent body 'block'", str(caught[0].message))

    def test_getting_and_setting(self):
        case = talus.Case(BLOCK)
        case["bodies[0].velocity"] = np.array([1.5, 0])
        case["method"] = "fem"
        self.assertEqual(case.settings(), ['bodies[0].velocity=[1.5, 0.0]', 'method="fem"'])
        self.assertEqual(case.resolved()["bodies"][0]["velocity"], [1.5, 0])
        del case["method"]
        self.assertEqual(case["method"], "mpm")
        self.assertEqual(case.measures, {"top": "m", "falling": "m/s", "mass": "kg"})
        with self.assertRaisesRegex(KeyError, "no 'materials.sand.young': no 'sand'; there are: rubber"):
            case["materials.sand.young"]
        with self.assertRaisesRegex(TypeError, "not object"):
            block(title=object()).check()
        with self.assertRaisesRegex(ValueError, "cannot hold nan"):
            block(**{"analysis.end": np.nan}).check()

    def test_what_is_set_last_holds(self):
        case = talus.Case(BLOCK)
        case["materials.rubber.young"] = 2e6
        case["materials.rubber"] = {"law": "neo-hookean", "density": 500, "young": 3e6, "poisson": 0.3}
        self.assertEqual(case["materials.rubber.young"], 3e6)
        case["materials.rubber.young"] = 4e6
        case["loads.gravity[1]"] = -5
        self.assertEqual(case["loads.gravity"], [0, -5])
        case["loads.gravity"] = [0, -1]
        self.assertEqual((case["loads.gravity[1]"], case["materials.rubber.density"]), (-1, 500))
        case["loads.gravity[1]"] = -2
        resolved = case.resolved()
        self.assertEqual((resolved["materials"]["rubber"]["young"], resolved["loads"]["gravity"]), (4e6, [0, -2]))
        self.assertEqual((case["materials.rubber"]["young"], case["loads.gravity"]), (4e6, [0, -2]))

    def test_a_sweep_over_texts(self):
        """A text with commas is one value."""
        titles = ["soft, then hard", "it's \"one\"", "plain"]
        swept = talus.sweep(talus.Case(BLOCK), {"title": titles}, measures=["top"], out="titles")
        self.assertEqual([run["title"] for run in [run.case for run in swept.runs]], titles)

    def test_keys_that_yaml_1_1_takes_for_truth(self):
        """PyYAML's safe_load has the key True for `on`."""
        case = block()
        case["boundary"] = [{True: {"boundary": "bottom"}, "fix": ["x", "y"]}]
        held = talus.Case(case.document)
        self.assertEqual(held["boundary[0].on.boundary"], "bottom")
        for one in (case, held):
            self.assertEqual(one.resolved()["boundary"][0]["on"], {"boundary": "bottom"})
        self.assertEqual(talus.run(held, "on").outcome, "done")

    def test_yaml_of_flow_collections(self):
        self.assertEqual(_yaml.loads('a: {b: [1, "x, y", {c: -.inf}], "d e": ""}  # end\nf: "a # b"\n'),
                         {"a": {"b": [1, "x, y", {"c": float("-inf")}], "d e": ""}, "f": "a # b"})


class Running(InFolder):
    def test_run_equals_the_program(self):
        program("run", BLOCK, "--out", "program", "--quiet")
        by_dict = block().run("dict")
        by_file = talus.run(BLOCK, "file")
        for run in (by_dict, by_file):
            self.assertEqual((run.path / "history.csv").read_text(), Path("program/history.csv").read_text())
        with self.assertRaisesRegex(talus.CaseError, "dict"):
            block().run("dict")
        block().run("dict", force=True)

    def test_a_dict_by_the_program(self):
        case = block(**{"materials.rubber.young": 2e6})
        seen = []
        run = talus.run(case, "by-program", progress=lambda step, time: seen.append((step, time)))
        self.assertEqual([step for step, _ in seen], [1, 2, 3, 4, 5])
        self.assertEqual(run.case["materials"]["rubber"]["young"], 2e6)
        talus.run(BLOCK, "cut", progress=lambda step, time: True)
        longer = talus.Case("cut")
        longer["analysis.end"] = 0.014
        del seen[:]
        run = talus.run(longer, "cut", resume=True, progress=lambda step, time: seen.append(step))
        self.assertEqual((seen[-1], run.history.time[-1]), (7, 0.014))
        self.assertEqual(list(Path(".").glob("talus-*")), [])
        case["materials.rubber.poison"] = 0.2
        with self.assertRaises(talus.CaseError) as caught:
            talus.run(case, "bad")
        self.assertEqual(caught.exception.mistakes[0].key, "materials.rubber.poison")

    def test_interrupted(self):
        """Ctrl-C, in this process and while the program runs: a checkpoint is written, and the run goes on from it."""
        endless = block(**{"analysis.end": 1e3})
        with self.assertRaisesRegex(KeyboardInterrupt, "by a signal, after step 3"):
            endless.run("endless", progress=lambda step, time, end: step == 3 and os.kill(os.getpid(), signal.SIGINT))
        self.assertEqual(talus.open("endless").outcome, "interrupted")
        with self.assertRaises(KeyboardInterrupt):  # Python has its own handler again
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1)

        def interrupt(step, time):
            raise KeyboardInterrupt

        for _ in range(2):  # the second time there is the log of the first
            with self.assertRaises(KeyboardInterrupt):
                talus.run(endless, "endless-program", force=True, progress=interrupt)
            run = talus.open("endless-program")
            self.assertEqual(run.outcome, "interrupted")
            self.assertTrue(list(run.path.glob("checkpoint_*.h5")))

    def test_a_run_that_gives_up(self):
        case = block(**{"newton.max_iterations": 1, "newton.residual": 1e-14, "analysis.smallest": 1e-3})
        with self.assertRaisesRegex(talus.RunError, "gave up") as caught:
            case.run("hard")
        self.assertEqual(caught.exception.run.outcome, "gave up")
        with self.assertRaisesRegex(talus.RunError, "gave up"):
            talus.run(case, "hard-program")
        with case.model() as model:
            with self.assertRaises(talus.RunError):
                model.step()
            self.assertEqual(model.time, 0)

    def test_what_a_callback_raises_ends_the_run(self):
        def fail(step, time, end):
            raise ZeroDivisionError(f"after step {step}")

        with self.assertRaisesRegex(ZeroDivisionError, "after step 1"):
            block().run("raised", progress=fail)
        self.assertEqual(talus.open("raised").outcome, "interrupted")
        case = block()
        case.body_force = lambda X, x, t: 1 / 0
        with self.assertRaises(ZeroDivisionError):
            case.run("raised-force")
        self.assertLessEqual(talus.open("raised-force").summary["steps"], 1)

    def test_a_run_within_a_run_leaves_the_signals_alone(self):
        def begin_another(step, time, end):
            if step == 1:
                block(**{"analysis.end": 0.004}).run("within")
            return step == 2 and os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaisesRegex(KeyboardInterrupt, "by a signal, after step 2"):
            block(**{"analysis.end": 1e3}).run("around", progress=begin_another)
        self.assertEqual(talus.open("within").outcome, "done")
        with self.assertRaises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1)

    def test_a_locale_with_commas(self):
        """Numbers are read and written with points, and the caller has its locale again."""
        os.mkdir("locales")
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", "locales/de_DE.UTF-8"], capture_output=True) \
            if shutil.which("localedef") else None
        if made is None or made.returncode:
            self.skipTest("there is no localedef, or no German")
        code = ("import locale, sys, talus\nlocale.setlocale(locale.LC_ALL, 'de_DE.UTF-8')\ncase = talus.Case(sys.argv[1])\n"
                "case['analysis.end'] = 0.004\nrun = case.run('commas')\nwith case.model() as model: model.step()\n"
                "print(run.history.time[-1], case['analysis.step'], locale.str(0.5))")
        done = subprocess.run([sys.executable, "-c", code, str(BLOCK)], capture_output=True, text=True,
                              env=dict(os.environ, LOCPATH=os.path.abspath("locales")))
        self.assertEqual((done.stdout, done.returncode), ("0.004 0.002 0,5\n", 0), done.stderr)

    def test_no_step_is_taken_with_a_force_that_raises(self):
        def fail(X, x, t):
            if t > 1e-3:
                raise ZeroDivisionError("no force")
            return 0

        with block().model() as model:
            model.body_force = fail
            with self.assertRaisesRegex(ZeroDivisionError, "no force"):
                model.step()
            self.assertEqual(model.time, 0)
            self.assertEqual(abs(model.points["displacement"]).max(), 0)
            model.body_force = None
            self.assertTrue(model.step())
            self.assertEqual(model.time, 0.002)  # as long as it would have been

    def test_what_a_body_force_may_return(self):
        with block(**{"loads.gravity": [0, 0]}).model() as model:
            n = len(model.points["mass"])
            for answer in (5.0, [5.0], [], [[5.0]], np.ones((n, 1)), np.ones((n, 0)), np.ones((n - 1, 2)), np.ones((1, n, 2))):
                with self.assertRaisesRegex(talus.TalusError, "returned numbers of shape"):
                    model.body_force = lambda X, x, t, answer=answer: answer
            for answer in (0, [1, 2], [1, 2, 0], [[1, 2]], np.ones((n, 2)), np.ones((n, 3))):
                model.body_force = lambda X, x, t, answer=answer: answer
                self.assertTrue(model.step(1e-3))

    def test_equilibrium_begins_with_the_body_force(self):
        """A column that begins in equilibrium under a force stays where it is, as under gravity."""
        tops = []
        for gravity, force in ([0, -9.81], None), ([0, 0], lambda X, x, t: [0, -9.81]):
            case = block(**{"loads.gravity": gravity, "initial.equilibrium": "direct"})
            case.body_force = force
            with case.model() as model:
                self.assertIs(model.body_force, force)
                tops.append([model.measures["top"]])
                for _ in range(3):
                    model.step()
                    tops[-1].append(model.measures["top"])
            tops.append(case.run("equilibrium", force=True).history["top"][:4])
        self.assertLess(np.ptp(tops[0]), 0.05 * abs(tops[0][0]))
        for top in tops[1:]:
            np.testing.assert_allclose(top, tops[0], rtol=1e-6)

    def test_a_model_ends_as_its_run(self):
        """With a condition of `until`; whoever asks for a step of a given length goes on."""
        case = block(**{"analysis.end": 0.1, "analysis.until": [{"measure": "top", "below": -1e-4}]})
        run = case.run("until").history
        self.assertLess(run.time[-1], 0.09)
        with case.model() as model:
            while model.step():
                pass
            self.assertEqual((model.time, model.measures["top"]), (run.time[-1], run.last["top"]))
            self.assertIn("top fell below -0.0001 m", library().text("TalusModelReason", model.handle))
            self.assertTrue(model.step(1e-3))

    def test_body_force_is_gravity(self):
        light = block(**{"loads.gravity": [0, 0]})
        light.body_force = lambda X, x, t: np.tile([0, -9.81, 0], (len(X), 1))
        by_force, heavy = light.run("force").history, block().run("weight").history
        np.testing.assert_allclose(by_force["top"], heavy["top"], rtol=1e-9)
        with self.assertRaisesRegex(talus.TalusError, "body_force: a function of this process"):
            talus.run(light, "force-program")

    def test_the_program_takes_no_functions(self):
        case = block(**{"loads.tractions": [{"on": {"body": "block", "y": 1}, "value": [0, 1]}]})
        case.loads["tractions[0]"] = lambda X, x, t: X[:, 0]
        for act in (lambda: talus.run(case, "factors"), lambda: talus.sweep(case, {"analysis.end": [0.004]}, out="swept")):
            with self.assertRaisesRegex(talus.TalusError, r"loads.tractions\[0\]: a function of this process"):
                act()
        case.loads["tractions[0]"] = None  # none at all
        self.assertEqual(talus.run(case, "factors").outcome, "done")

    def test_a_run_goes_on_with_its_functions_alone(self):
        case = block(**{"loads.tractions": [{"on": {"body": "block", "y": 1}, "value": [0, -100]}]})
        case.body_force = lambda X, x, t: np.stack([100 * t + X[:, 1], -x[:, 0]], axis=1)
        case.loads["tractions[0]"] = lambda X, x, t: 1 + X[:, 0] + 100 * t + x[:, 1]
        whole = case.run("whole")
        functions = {"body_force": case.body_force, "loads": case.loads}
        for steps in (2, 0):  # from a checkpoint; from none: the run starts again
            case.run("cut", force=True, progress=lambda step, time, end: step == 2)
            if not steps:
                [file.unlink() for file in Path("cut").glob("checkpoint_*.h5")]
            before = sorted((file.name, file.stat().st_size) for file in Path("cut").iterdir() if file.name != "log.txt")
            for lacking in ({}, {"body_force": case.body_force}, {"loads": case.loads}):
                with self.assertRaisesRegex(talus.CaseError, r"has functions of its caller for: body_force, loads.tractions\[0\]"):
                    talus.Case("cut", **lacking).run("cut", resume=True)
            with self.assertRaisesRegex(talus.CaseError, "now there are: none"):
                talus.run("cut", "cut", resume=True)
            self.assertEqual(before, sorted((file.name, file.stat().st_size) for file in Path("cut").iterdir() if file.name != "log.txt"))
            talus.Case("cut", **functions).run("cut", resume=True)
            self.assertEqual((whole.path / "history.csv").read_text(), Path("cut/history.csv").read_text())
            last, first = (talus.open(run).states[-1].points["displacement"] for run in ("cut", "whole"))
            np.testing.assert_array_equal(last, first)
        block().run("cut", force=True, progress=lambda step, time, end: step == 2)  # none this time
        with self.assertRaisesRegex(talus.CaseError, "for: none; now there are: body_force"):
            talus.Case("cut", body_force=case.body_force).run("cut", resume=True)
        self.assertEqual(talus.Case("cut").run("cut", resume=True).outcome, "done")

    def test_a_run_is_not_run_from_within(self):
        case = block()
        case.body_force = lambda X, x, t: case.run("inner")
        with self.assertRaisesRegex(talus.TalusError, "the case is being run"):
            case.run("outer")
        self.assertFalse(Path("inner").exists())
        case.body_force = None
        case.run("outer", force=True)

    def test_body_force_goes_through_stages(self):
        """Gravity as a function, in two stages, cut off in the second and resumed."""
        stages = [{"name": "falls"}, {"name": "stiffens", "materials": {"hard": {
            "law": "neo-hookean", "density": 1000, "young": 2e6, "poisson": 0.3}}, "bodies": [{"name": "block", "material": "hard"}]}]
        heavy = block(stages=stages)
        whole = heavy.run("stages").history
        self.assertEqual((whole["stage"][-1], whole.time[-1]), (2, 0.02))
        light = block(**{"loads.gravity": [0, 0], "stages": stages})
        light.body_force = lambda X, x, t: [0, -9.81, 0]
        light.run("stages-force", progress=lambda step, time, end: step == 7)
        again = talus.Case("stages-force", body_force=light.body_force)
        found = again.run("stages-force", resume=True).history
        np.testing.assert_allclose(found["top"], whole["top"], rtol=1e-9)

    def test_trust(self):
        Path("square.geo").write_text('Point(1) = {0, 0, 0, 0.5}; l() = Extrude {1, 0, 0} { Point{1}; };\n'
                                      's() = Extrude {0, 1, 0} { Curve{l(1)}; };\nPrintf("x") > "made";\n')
        case = talus.Case({"kinematics": "plane-strain", "method": "fem", "analysis": {"type": "static", "steps": 1},
                           "grid": {"mesh": "square.geo"},
                           "bodies": [{"name": "b", "shape": {"box": {"min": [0, 0], "max": [1, 1]}}, "points_per_cell": 3,
                                       "material": "m"}],
                           "materials": {"m": {"law": "neo-hookean", "density": 1, "young": 1, "poisson": 0}},
                           "boundary": [{"on": {"x": 0}, "fix": ["x", "y"]}]})
        with self.assertRaisesRegex(talus.CaseError, "square.geo:3:13"):
            case.run("untrusted")
        self.assertFalse(Path("made").exists())


class Stepping(InFolder):
    def test_steps_equal_the_run(self):
        run = block().run("run")
        with block().model() as model:
            steps = 0
            while model.step():
                steps += 1
                self.assertEqual(model.measures["top"], run.history["top"][steps])
            self.assertEqual((steps, model.time, model.end, model.measures.units["top"]), (5, 0.01, 0.01, "m"))

    def test_views_are_the_model_s_own(self):
        with block().model() as model:
            model.step()
            points = model.points
            for name, width in (("position", 2), ("velocity", 2), ("deformation_gradient", 5), ("kirchhoff_stress", 4)):
                first, again = points[name], points[name]
                self.assertEqual(first.shape, (64, width), name)
                self.assertTrue(np.shares_memory(first, again) and not first.flags.writeable, name)
            np.testing.assert_array_equal(library_copy(model, "velocity")[:, :2], points["velocity"])
            F = points["deformation_gradient"]
            J = (F[:, 0] * F[:, 3] - F[:, 1] * F[:, 2]) * F[:, 4]
            np.testing.assert_allclose(points["stress"][:, [0, 1, 2, 3]] * J[:, None], points["kirchhoff_stress"], rtol=1e-9, atol=1e-6)
            np.testing.assert_allclose(points["mass"], points["density"] * points["volume"], rtol=1e-12)
            with self.assertRaises(ValueError):
                points["velocity"][0] = 1
            with self.assertRaisesRegex(KeyError, "no field 'colour'"):
                points["colour"]

    def test_a_velocity_that_is_set_is_that_of_the_case(self):
        with block(**{"bodies[0].velocity": [0.5, -1]}).model() as given, block().model() as changed:
            with changed.points.edit("velocity") as v:
                v[:] = [0.5, -1]
            with self.assertRaises(ValueError):
                v[0] = 0  # only within
            while given.step() and changed.step():
                np.testing.assert_array_equal(changed.points["velocity"], given.points["velocity"])

    def test_what_cannot_be_changed(self):
        case = block(method="fem")
        del case["basis"]
        with case.model() as model:
            with self.assertRaisesRegex(talus.TalusError, "nodes keep the motion"):
                model.points.edit("velocity").__enter__()
            with self.assertRaisesRegex(talus.TalusError, "cannot be changed"):
                model.points.edit("position").__enter__()
            with self.assertRaisesRegex(KeyError, "computed from other fields"):
                model.points.edit("stress").__enter__()

    def test_momentum_follows_a_force_of_place_and_time(self):
        """A free block under b = (2 t, -x): its momentum grows by the sum of mass times force, step by step."""
        case = block(**{"loads.gravity": [0, 0], "analysis.end": 0.05, "grid.box.min": [-1, -1.5], "grid.box.max": [3, 2.5],
                        "grid.counts": [16, 16], "boundary": []})
        with case.model() as model:
            asked = []

            def force(X, x, t):
                asked.append((t, x.copy()))
                return np.stack([np.full(len(x), 2 * t), -x[:, 0]], axis=1)

            model.body_force = force
            momentum, before = np.zeros(2), None
            while model.step():
                t, x = asked[-1]
                now = np.array([2 * t * 1000, -(model.points["mass"] * x[:, 0]).sum()])
                dt = 0.002
                if before is not None:
                    momentum += 0.5 * dt * (now + before)  # Newmark with gamma = 1/2
                else:
                    momentum += 0.5 * dt * (now + [0, -(1000 * 0.75)])
                before = now
            found = (model.points["mass"][:, None] * model.points["velocity"]).sum(axis=0)
            np.testing.assert_allclose(found, momentum, rtol=2e-3)
            self.assertGreater(abs(found[1]), 30)

    def test_momentum_follows_a_traction_of_place_and_time(self):
        """A free block whose top bears (t x, -x^2) and whose left side a pressure of 2 y: its momentum is the integral."""
        asked, end = [], 0.02

        def traction(X, x, t):
            asked.append(len(X))
            return np.stack([t * X[:, 0], -X[:, 0] ** 2], axis=1)

        case = block(**{"loads": {"tractions": [{"on": {"body": "block", "y": 1}, "value": [1, 1]}],
                                  "pressures": [{"on": {"body": "block", "x": 0.25}, "value": 1}]},
                        "analysis.end": end, "boundary": []})
        case.loads = {"tractions[0]": traction, "pressures[0]": lambda X, x, t: 2 * X[:, 1]}
        mean, square = 0.75, (1.25**3 - 0.25**3) / 3  # of x over the top
        wanted = [mean * end**2 / 2 + 1 * end, -square * end]
        with case.model() as model:
            while model.step():
                pass
            found = (model.points["mass"][:, None] * model.points["velocity"]).sum(axis=0)
            np.testing.assert_allclose(found, wanted, rtol=1e-6)  # the pressure follows: the side stretches by 1e-7
            self.assertEqual(set(asked), {16})  # two Gauss points of each piece of the surface, half a cell long
            model.vary("tractions[0]", None)
            model.vary("pressures[0]", lambda X, x, t: 0)  # one number for all places
            model.step(0.002), model.step(0.002)
            before = (model.points["mass"][:, None] * model.points["velocity"]).sum(axis=0)
            with self.assertRaisesRegex(KeyError, r"no load 'pressures\[1\]'"):
                model.vary("pressures[1]", None)
            model.vary("tractions[0]", lambda X, x, t: [1, 2, 3, 4])
            with self.assertRaisesRegex(talus.TalusError, "4 numbers for 16 places"):
                model.step(0.002)
        # Its value again, 1 N/m2 upward: half of the first step is still the function's.
        self.assertAlmostEqual(before[1] - found[1], 0.001 * (1 - square) + 0.002, delta=1e-6 * 0.002)

    def test_a_load_on_few_places(self):
        """fem asks of one place for each face. A vector for all of them is no number for each, however many there are."""
        for n in (1, 2, 3, 4):
            case = talus.Case({"kinematics": "plane-strain", "method": "fem", "analysis": {"type": "dynamic", "end": 0.01, "step": 0.005},
                               "grid": {"box": {"min": [0, 0], "max": [1, 1]}, "counts": [n, n]},
                               "bodies": [{"name": "block", "shape": {"box": {"min": [0, 0], "max": [1, 1]}}, "material": "rubber"}],
                               "materials": {"rubber": {"law": "neo-hookean", "density": 1000, "young": 1e5, "poisson": 0.3}},
                               "loads": {"tractions": [{"on": {"x": 0}, "value": [100, 100]}]}})
            for vector in ([1, 0], [1, 0, 0]):
                case.loads["tractions[0]"] = lambda X, x, t: vector
                with self.assertRaisesRegex(talus.TalusError, r"numbers for . places.*\[\[1, 0\]\]"):
                    case.run("few", force=True)
            for factors, wanted in ((lambda X: [[1, 0]], [1, 0]), (lambda X: np.ones(len(X)), [1, 1]), (lambda X: 1, [1, 1]),
                                    (lambda X: np.tile([0, 1], (len(X), 1)), [0, 1]),
                                    (lambda X: 2 * X[:, 1], [1, 1]), (lambda X: 2 * X[:, 1:2], [1, 1])):
                case.loads["tractions[0]"] = lambda X, x, t: factors(X)
                with case.model() as model:
                    while model.step():
                        pass
                    momentum = (model.points["mass"][:, None] * model.points["velocity"]).sum(axis=0)
                np.testing.assert_allclose(momentum, np.array(wanted) * 100 * 0.01, atol=1e-8)

    def test_places_are_the_functions_own(self):
        """Kept, they stay what they were; changed, they change nothing."""
        case = block(**{"loads": {"gravity": [0, 0], "tractions": [{"on": {"body": "block", "y": 1}, "value": [0, 1]}]}})
        kept = []

        def force(X, x, t):
            kept.append((X, x, X.copy(), x.copy()))
            return [0, -9.81]

        def spoil(X, x, t):
            answer = X[:, 0] + x[:, 1]
            X -= 1
            x += 1
            return answer

        found = []
        for load in (lambda X, x, t: X[:, 0] + x[:, 1], spoil):
            case.body_force, case.loads["tractions[0]"] = force, load
            found.append(case.run("own", force=True).history["top"])
        np.testing.assert_array_equal(*found)
        for X, x, X_then, x_then in kept:
            np.testing.assert_array_equal(X, X_then)
            np.testing.assert_array_equal(x, x_then)

    def test_the_time_of_a_function(self):
        """That of the balance: the middle of a step, its end, or the start of a substep."""
        explicit = {"type": "explicit", "end": 0.01, "step": 0.0002}
        for changes, times in (({"analysis.transfer": "consistent"}, {0.5}), ({}, {0, 1}), ({"analysis": explicit}, {0, 1})):
            asked, case = set(), block(**changes)
            with case.model() as model:
                model.body_force = lambda X, x, t: (asked.add(t), [0, 0])[1]
                asked.clear()  # that was for the acceleration at the start
                model.step()
                self.assertEqual({round(t / model.time, 9) for t in asked}, times)

    def test_loads_act_in_runs(self):
        case = block(**{"loads": {"gravity": [0, 0], "tractions": [{"on": {"body": "block", "y": 1}, "value": [0, -500]}]}})
        plain = case.run("runs/plain").history["top"]
        case["loads.tractions"] = [{"on": {"body": "block", "y": 1}, "value": [0, 1]}]
        case.loads["tractions[0]"] = lambda X, x, t: np.full(len(X), -500.0)
        np.testing.assert_allclose(case.run("runs/asked").history["top"], plain, rtol=1e-12)
        case.loads["points[0]"] = case.loads["tractions[0]"]
        with self.assertRaisesRegex(KeyError, r"no load 'points\[0\]'"):
            case.run("runs/none")
        del case.loads["points[0]"]
        case["stages"] = [{"name": "one"}, {"name": "two", "analysis": {"end": 0.02}}]
        with self.assertRaisesRegex(talus.CaseError, "not for cases with stages"):
            case.run("runs/stages")

    def test_what_a_step_asks_leaves_its_model_alone(self):
        with block().model() as model:
            for meddle in (model.step, model.close, lambda: setattr(model, "body_force", None),
                           lambda: model.vary("tractions[0]", None)):
                model.body_force = None
                with self.assertRaisesRegex(talus.TalusError, "a model or a run is at work"):
                    model.body_force = lambda X, x, t: meddle()
                    model.step()
            model.body_force = None
            self.assertTrue(model.step())

    def test_a_function_that_forgets_its_return(self):
        case = block(**{"loads.tractions": [{"on": {"body": "block", "y": 1}, "value": [0, 1]}]})
        with case.model() as model:
            with self.assertRaisesRegex(talus.TalusError, "the function of body_force returned None"):
                model.body_force = lambda X, x, t: None
                model.step()
            model.body_force = None
            with self.assertRaisesRegex(talus.TalusError, "the function of a load returned None"):
                model.vary("tractions[0]", lambda X, x, t: None)
                model.step()

    def test_closing(self):
        model = block().model()
        model.close()
        model.close()
        self.assertIn("closed", repr(model))
        for use in (model.step, lambda: model.time, lambda: model.points["position"], lambda: model.points["stress"],
                    lambda: model.measures["top"], lambda: setattr(model, "body_force", None)):
            with self.assertRaisesRegex(talus.TalusError, "the model is closed"):
                use()
        code = ("import talus, sys; case = talus.Case(sys.argv[1]); model = case.model(); model.step(); print('left open')")
        done = subprocess.run([sys.executable, "-c", code, str(BLOCK)], capture_output=True, text=True, env=dict(os.environ))
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "left open\n", ""))


def library_copy(model, name):
    return model.points._computed(name)


if __name__ == "__main__":
    unittest.main()
