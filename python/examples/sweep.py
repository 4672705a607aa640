"""How far does a column of grains run out? A sweep over the angle of friction, several runs at a time."""

from pathlib import Path

import talus

column = Path(__file__).with_name("column.yaml")
angles = [25, 31, 37]
found = talus.sweep(column, {"materials.grains.friction_angle": angles}, measures=["run_out"],
                    out="runs/friction-sweep")

print("friction [deg]   run-out")
for angle, run_out in zip(angles, found.table["run_out"]):
    print(f"{angle:14g} {run_out:9.3f}")

# Each row has its run: how far had the front come by half the time?
for angle, run in zip(angles, found.runs):
    time, front = run.history.time, run.history["front"]
    print(f"{angle} degrees: the front stood at {front[time <= time[-1] / 2][-1]:.4f} m at {time[-1] / 2:g} s")
