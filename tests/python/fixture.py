"""What the tests share: a folder for each class of tests, the block of the C library's tests, the program."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
BLOCK = SOURCE / "tests" / "api" / "block.yaml"


def talus(*words):
    """Run the program, which must do its work."""
    subprocess.run([os.environ["TALUS_PROGRAM"], *map(str, words)], check=True, stdout=subprocess.DEVNULL)


class InFolder(unittest.TestCase):
    """Each class works in a folder of its own, which goes with it."""

    @classmethod
    def setUpClass(cls):
        cls.before = os.getcwd()
        cls.folder = tempfile.TemporaryDirectory(prefix="talus-python-")
        os.chdir(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        os.chdir(cls.before)
        cls.folder.cleanup()
