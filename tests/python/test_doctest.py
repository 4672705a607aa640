"""The examples of all docstrings run."""

import doctest
import importlib
import inspect
import os
import pkgutil
import re
import unittest
import warnings

import numpy as np

import talus
from fixture import BLOCK, SOURCE, InFolder
from fixture import talus as program


class Docstrings(InFolder):
    def test_examples(self):
        program("run", BLOCK, "--out", "runs/block", "--quiet")
        talus.sweep(BLOCK, {"materials.rubber.young": [1e6, 2e6]}, measures=["top"], out="runs/sweep")
        names = dict(talus=talus, np=np, run="runs/block", sweep="runs/sweep", block=str(BLOCK))
        attempted = 0
        for module in pkgutil.iter_modules(talus.__path__, "talus."):
            module = importlib.import_module(module.name)
            result = doctest.testmod(module, extraglobs=names)
            self.assertEqual(result.failed, 0, module.__name__)
            attempted += result.attempted
        self.assertGreater(attempted, 30)

    def test_the_page(self):
        """The sessions of docs/python.md, one after the other, as a reader would type them."""
        os.symlink(SOURCE / "python", "python")
        page = (SOURCE / "docs" / "python.md").read_text()
        sessions = re.findall(r"```pycon\n(.*?)```", page, re.S)
        self.assertGreater(len(sessions), 8)
        names, runner = {}, doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
        for number, session in enumerate(sessions):
            test = doctest.DocTestParser().get_doctest(session, names, f"docs/python.md, session {number + 1}", None, 0)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", talus.TalusWarning)  # the column is coarse, and says so
                runner.run(test, clear_globs=False)
            names = test.globs
        self.assertEqual(runner.summarize().failed, 0)

    def test_everything_public_is_told(self):
        for name in talus.__all__:
            thing = getattr(talus, name)
            self.assertTrue(thing.__doc__, name)
            for member, value in vars(thing).items() if inspect.isclass(thing) else ():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    self.assertTrue(inspect.getdoc(getattr(thing, member)), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
