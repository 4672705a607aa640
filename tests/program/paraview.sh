#!/bin/sh
# ParaView reads what talus writes: points, grid, walls and contact at their times, with their fields; and the tutorial's script draws.
page="$(cd "$(dirname "$0")/../../docs/tutorial" && pwd)/7-paraview.md" slope="$(dirname "$page")/3-slope.md"
. "$(dirname "$0")/library.sh"
command -v pvpython >/dev/null || { echo "skipped: there is no pvpython"; exit 77; }
export LC_ALL=C.UTF-8
# Once: two screens of xvfb-run, one just after the other, get the same number, and the second is sent away.
draw() {
  if [ -n "${DISPLAY:-}" ] || ! command -v xvfb-run >/dev/null; then pvbatch --force-offscreen-rendering "$1"
  else xvfb-run -a pvbatch "$1"; fi
}

# written FILE NAME: what the page tells to write into the file NAME.
written() { awk -v name="$2" '$0 == "```" { inside = 0 } inside { print } $1 ~ /^```/ && $2 == name { inside = 1 }' "$1"; }

# A block of 1 x 1 m falls 0.2 s freely, by the trapezium exactly, above a wall that it does not reach; one in space is pressed by a tenth.
cat >fall.yaml <<'END'
title: A block falls
kinematics: plane-strain
method: mpm
basis: {cell: {}}
analysis: {type: dynamic, end: 0.2, step: 0.05}
grid: {box: {min: [0, 0], max: [2, 2]}, size: 0.25, cell: quadrilateral}
bodies:
  - {name: block, shape: {box: {min: [0.5, 0.75], max: [1.5, 1.75]}}, points_per_cell: 4, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
walls:
  - {name: floor, shape: {half-space: {point: [0, 0.25], normal: [0, 1]}}, contact: frictionless}
loads: {gravity: [0, -10]}
output: {fields: [displacement, velocity, stress], every: {steps: 2}}
END
cat >stand.yaml <<'END'
title: A block stands
kinematics: 3d
method: fem
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0, 0], max: [1, 1, 1]}, counts: [2, 2, 2], cell: hexahedron}
bodies:
  - {name: block, shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, points_per_cell: 8, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0}
boundary:
  - {name: foot, on: {z: 0}, fix: [z]}
  - {name: left, on: {x: 0}, fix: [x]}
  - {name: front, on: {y: 0}, fix: [y]}
  - {name: top, on: {z: 1}, displacement: {z: -0.1}}
output: {fields: [displacement, velocity, stress], every: {steps: 1}}
END
expect "a block falls" 0 "$talus" run fall.yaml --out fall
expect "a block rests" 0 "$talus" run fall.yaml --out rest --set 'bodies[0].shape={box: {min: [0.5, 0.25], max: [1.5, 1.25]}}'
expect "a block is pressed" 0 "$talus" run stand.yaml --out stand

cat >look.py <<'END'
import os
import sys
from paraview.simple import OpenDataFile

def look(path, count, points, cells, **ranges):
    """As many states; in the last so many points and cells, and (least, most) of a component of a field: name_component."""
    source = OpenDataFile(path)
    times = list(source.TimestepValues)
    assert len(times) == count, f"{path}: times {times}"
    source.UpdatePipeline(times[-1])
    info = source.GetDataInformation()
    assert info.GetNumberOfPoints() == points, f"{path}: {info.GetNumberOfPoints()} points"
    assert cells is None or info.GetNumberOfCells() == cells, f"{path}: {info.GetNumberOfCells()} cells"
    for name, (least, most) in ranges.items():
        field, component = name.rsplit("_", 1)
        found = source.PointData[field].GetRange(int(component))
        assert max(abs(found[0] - least), abs(found[1] - most)) < 1e-6 * max(1, abs(most)), f"{path}: {name} {found}"
    return times

g, t = 10, 0.2
times = look("fall/points.hdf.series", 3, 64, None, displacement_0=(0, 0), displacement_1=(-g * t * t / 2,) * 2, velocity_1=(-g * t,) * 2)
assert max(abs(a - b) for a, b in zip(times, (0, 0.1, 0.2))) < 1e-12, times
look("fall/grid.hdf.series", 3, 81, 64)
look("stand/points.hdf.series", 3, 64, None)
look("stand/grid.hdf.series", 3, 27, 8, displacement_2=(-0.1, 0))
assert os.path.exists("fall/walls.hdf.series")
walls = OpenDataFile("fall/walls.hdf.series")
walls.UpdatePipeline()
bounds = walls.GetDataInformation().GetBounds()
assert abs(bounds[3] - 0.25) < 1e-9, bounds
contact = OpenDataFile("rest/contact.hdf.series")
contact.UpdatePipeline(t)
assert contact.GetDataInformation().GetNumberOfPoints() > 0 and contact.PointData.keys(), "no contact"
print("seen")
END
expect "ParaView reads states" 0 pvpython look.py
says out.txt seen

# The tutorial's picture, of a slide that has just begun.
written "$slope" slope.yaml >slope.yaml
written "$page" slide.py >slide.py
expect "a slide" 0 "$talus" run slope.yaml --out runs/slide --set 'analysis={type: dynamic, end: 0.1, step: 0.02}' \
  --set materials.clay.cohesion=3e3 --set output.every=0.1 --set grid.size=1
expect "the tutorial's script" 0 draw slide.py
cat >colours.py <<'END'
import vtk
reader = vtk.vtkPNGReader()
reader.SetFileName("slide.png")
reader.Update()
image = reader.GetOutput()
values = image.GetPointData().GetScalars()
some = {values.GetTuple(i)[:3] for i in range(0, values.GetNumberOfTuples(), 7)}
print(image.GetDimensions()[:2], "colours", len(some) > 50, len(some))
END
expect "a picture" 0 pvpython colours.py
says out.txt "(1000, 480) colours True"
finish
