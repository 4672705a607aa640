#!/usr/bin/env python3
"""The final surface of runs of this case beside the measured one (measured.csv), drawn into surface.png by gnuplot: from the volume of the points
above x, in columns of 4 mm, linear between them.

    python3 surface.py TITLE=RUN [TITLE=RUN ...]     # at most four, for instance "mu(I), 2 mm=runs/fine" """
import csv
import glob
import os
import subprocess
import sys
import h5py
import numpy as np

COLUMN, VOLUME, END = 0.004, 0.02, 0.6  # m, m3/m of all bars, m
HERE = os.path.dirname(os.path.abspath(__file__))


def measured():
    rows = [row for row in csv.reader(open(os.path.join(HERE, "measured.csv"))) if row and row[0][0].isdigit()]
    return np.array(rows, float)


def profile(run):
    """x, height: points share their volume between the two nearest columns."""
    with h5py.File(sorted(glob.glob(os.path.join(run, "points_*.hdf")))[-1]) as states:
        x = np.array(states["VTKHDF/Points"])[:, 0]
    n = round(END / COLUMN) + 1
    left = np.clip((x / COLUMN).astype(int), 0, n - 2)
    share = x / COLUMN - left
    height = np.zeros(n)
    np.add.at(height, left, 1 - share)
    np.add.at(height, left + 1, share)
    height *= VOLUME / len(x) / COLUMN
    height[[0, -1]] *= 2
    return COLUMN * np.arange(n), height


def main(runs):
    given, lines = measured(), []
    script = ["set terminal pngcairo size 1000,360 font 'sans,11'", "set output 'surface.png'", "set grid lc rgb '#dddddd'",
              "set xlabel 'x [m]'", "set ylabel 'height of the surface [m]'", "set xrange [0:0.52]", "set yrange [0:0.105]"]
    for k, (title, run) in enumerate(entry.split("=", 1) for entry in runs):
        x, height = profile(run)
        off = np.interp(given[:, 0], x, height) - given[:, 1]
        print(f"{title}: mean error {1e3 * np.abs(off).mean():.1f} mm, largest {1e3 * np.abs(off).max():.1f} mm")
        data = "\n".join(f"{a:g} {b:g}" for a, b in zip(x, height))
        script.append(f"$run{k} << EOD\n{data}\nEOD")
        lines.append(f"$run{k} using 1:2 with lines lw 2 lc {k + 1} title '{title}'")
    points = "\n".join(f"{a:g} {b:g}" for a, b in given)
    script.append(f"$measured << EOD\n{points}\nEOD")
    lines.append("$measured using 1:2 with points pt 7 ps 1 lc rgb 'black' title 'measured (Bui et al. 2008)'")
    subprocess.run(["gnuplot"], input="\n".join(script + ["plot " + ", ".join(lines)]) + "\n", text=True, check=True)


main(sys.argv[1:])
