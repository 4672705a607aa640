"""The examples of all docstrings run."""

import doctest
import importlib
import inspect
import pkgutil
import unittest

import numpy as np

import talus
from fixture import BLOCK, InFolder
from fixture import talus as program


class Docstrings(InFolder):
    def test_examples(self):
        program("run", BLOCK, "--out", "runs/block", "--quiet")
        program("sweep", BLOCK, "--over", "materials.rubber.young=1e6,2e6", "--measure", "top", "--out", "runs/sweep")
        names = dict(talus=talus, np=np, run="runs/block", sweep="runs/sweep", block=str(BLOCK))
        attempted = 0
        for module in pkgutil.iter_modules(talus.__path__, "talus."):
            module = importlib.import_module(module.name)
            result = doctest.testmod(module, extraglobs=names)
            self.assertEqual(result.failed, 0, module.__name__)
            attempted += result.attempted
        self.assertGreater(attempted, 30)

    def test_everything_public_is_told(self):
        for name in talus.__all__:
            thing = getattr(talus, name)
            self.assertTrue(thing.__doc__, name)
            for member, value in vars(thing).items() if inspect.isclass(thing) else ():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    self.assertTrue(inspect.getdoc(getattr(thing, member)), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
