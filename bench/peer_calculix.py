#!/usr/bin/env python3
"""peer_calculix.py: the cantilever of cases/cantilever by CalculiX; bench_table reads the line that it prints.

The same cells as finite elements (CPE4, which CalculiX makes solid ones of), St. Venant-Kirchhoff for the Neo-Hookean
law (strains are small, the turn is not), all of the weight in one step. Seconds are those of the whole process."""
import os
import re
import resource
import shutil
import subprocess
import tempfile

PER_METRE, LENGTH, HEIGHT = 32, 8, 1


def deck():
    nx, ny = LENGTH * PER_METRE, HEIGHT * PER_METRE

    def node(i, j):
        return 1 + j * (nx + 1) + i

    def lines(kind, rows):
        return [kind] + [", ".join(map(str, row)) for row in rows]

    nodes = [(node(i, j), i / PER_METRE, j / PER_METRE, 0) for j in range(ny + 1) for i in range(nx + 1)]
    cells = [
        (1 + j * nx + i, node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))
        for j in range(ny)
        for i in range(nx)
    ]
    text = lines("*NODE", nodes) + lines("*ELEMENT, TYPE=CPE4, ELSET=BEAM", cells)
    text += lines("*NSET, NSET=WALL", [(node(0, j),) for j in range(ny + 1)])
    text += lines("*NSET, NSET=TIP", [(node(nx, ny // 2),)])
    text += ["*MATERIAL, NAME=RUBBER", "*ELASTIC", "90e6, 0", "*DENSITY", "1000"]
    text += ["*SOLID SECTION, ELSET=BEAM, MATERIAL=RUBBER", "1", "*BOUNDARY", "WALL, 1, 2"]
    text += ["*STEP, NLGEOM", "*STATIC", "1, 1", "*DLOAD", "BEAM, GRAV, 9.81, 0, -1, 0"]
    text += ["*NODE PRINT, NSET=TIP", "U", "*END STEP", ""]
    return 4 * len(cells), "\n".join(text)


def main():
    program = shutil.which("ccx")
    if not program:
        print("not installed: apt install calculix-ccx")
        return
    points, text = deck()
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "beam.inp"), "w", encoding="ascii") as file:
            file.write(text)
        one = dict(os.environ, OMP_NUM_THREADS="1")
        run = subprocess.run([program, "beam"], cwd=folder, env=one, capture_output=True, text=True, check=True)
        with open(os.path.join(folder, "beam.dat"), encoding="ascii") as file:
            tip = float(file.read().split()[-2])
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    increments = len(re.findall(r"^ increment \d+ attempt", run.stdout, re.MULTILINE))
    print(f"{points} points, {increments} steps, {used.ru_utime + used.ru_stime:.4f} s of a core, tip {tip:.6f} m")


if __name__ == "__main__":
    main()
