"""Two ranks with mpi4py, started by mpiexec: the numbers of one rank, and halves that work on two cases."""

import sys
import unittest

try:
    from mpi4py import MPI
except ImportError:
    print("skipped: mpi4py is not here (Debian: python3-mpi4py)")
    sys.exit(77)

import numpy as np

import talus
from fixture import BLOCK


def final(case):
    """Velocity of the top at the end, momentum over all ranks of the case, and steps."""
    comm = case.comm or MPI.COMM_WORLD
    with case.model() as model:
        steps = 0
        while model.step():
            steps += 1
        mass, velocity = model.points["mass"], model.points["velocity"]
        momentum = comm.allreduce((mass[:, None] * velocity).sum(axis=0))
        return np.array([model.measures["falling"], *momentum, steps])


class Ranks(unittest.TestCase):
    def same(self, a, b):
        """To 1e-9, as a whole: the momentum has a component that is round-off."""
        self.assertLessEqual(np.abs(a[1:] - b[1:]).max(), 1e-9 * np.abs(b[1:]).max())
        self.assertAlmostEqual(a[0], b[0], delta=1e-9 * abs(b[0]))

    def test_all_ranks(self):
        shared, alone = final(talus.Case(BLOCK)), final(talus.Case(BLOCK, comm=MPI.COMM_SELF))
        self.same(shared, alone)

    def test_a_half_each(self):
        rank = MPI.COMM_WORLD.rank
        half = MPI.COMM_WORLD.Split(rank % 2)
        case = talus.Case(BLOCK, comm=half)
        if rank % 2:
            case["analysis.step"] = 0.001
        self.assertEqual(final(case)[-1], 10 if rank % 2 else 5)
        half.Free()

    def test_a_load_on_few_places_of_each_rank(self):
        """Two faces each: a number for each place, and none for a vector."""
        case = talus.Case({"kinematics": "plane-strain", "method": "fem", "analysis": {"type": "dynamic", "end": 0.01, "step": 0.005},
                           "grid": {"box": {"min": [0, 0], "max": [1, 1]}, "counts": [4, 4]},
                           "bodies": [{"name": "b", "shape": {"box": {"min": [0, 0], "max": [1, 1]}}, "material": "m"}],
                           "materials": {"m": {"law": "neo-hookean", "density": 1000, "young": 1e5, "poisson": 0.3}},
                           "loads": {"tractions": [{"on": {"y": 0}, "value": [100, 100]}]}})
        for factors in (lambda X: 2 * X[:, 0], lambda X: [[1, 1]]):
            case.loads["tractions[0]"] = lambda X, x, t: factors(X)
            with case.model() as model:
                while model.step():
                    pass
                momentum = (model.points["mass"][:, None] * model.points["velocity"]).sum(axis=0)
            np.testing.assert_allclose(MPI.COMM_WORLD.allreduce(momentum), [1, 1], atol=1e-8)
        case.loads["tractions[0]"] = lambda X, x, t: [1, 0]
        with self.assertRaisesRegex(talus.TalusError, "2 numbers for"), case.model() as model:
            model.step()

    def test_forces_are_asked_on_every_rank(self):
        case = talus.Case(BLOCK)
        case["loads.gravity"] = [0, 0]
        asked = []

        def gravity(X, x, t):
            asked.append(len(X))
            return np.broadcast_to([0, -9.81], (len(X), 2))

        case.body_force = gravity
        self.same(final(case), final(talus.Case(BLOCK)))
        self.assertEqual(MPI.COMM_WORLD.allreduce(asked[-1]), 64)

    def test_loads_are_asked_on_every_rank(self):
        case = talus.Case(BLOCK, loads={"tractions[0]": lambda X, x, t: np.stack([X[:, 0], -np.ones(len(X))], axis=1)})
        case["loads.tractions"] = [{"on": {"body": "block", "y": 1}, "value": [100, 100]}]
        alone = talus.Case(BLOCK, comm=MPI.COMM_SELF, loads=case.loads)
        alone["loads.tractions"] = case["loads.tractions"]
        shared = final(case)
        self.same(shared, final(alone))
        self.assertGreater(abs(shared - final(talus.Case(BLOCK))).max(), 0.1)

    def test_mistakes_are_told_to_all(self):
        case = talus.Case(BLOCK)
        case["materials.rubber.yung"] = 1
        with self.assertRaisesRegex(talus.CaseError, "did you mean 'young'"):
            case.check()


if __name__ == "__main__":
    assert MPI.COMM_WORLD.size > 1, "to be started by mpiexec"
    unittest.main(verbosity=0)
