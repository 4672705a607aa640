#!/usr/bin/env python3
"""peer_kratos.py column|cantilever [FOLDER]: a case of bench_table by the MPMApplication of Kratos, on one core.

Writes a project of Kratos, runs it, and prints the line that bench_table reads; with FOLDER the project is only written
there (`talus import kratos FOLDER` makes a case of it). Seconds are those of the loop over steps. column: as in
cases/granular-collapse, for 0.05 s, without damping; cantilever: as in cases/cantilever, cells of 1/32 m."""
import json
import math
import os
import sys
import tempfile
import time

COLUMN = {
    "solver": {"solver_type": "Dynamic", "scheme_type": "newmark", "time_integration_method": "implicit",
               "consistent_mass_matrix": True, "time_stepping": {"time_step": 1e-3},
               "linear_solver_settings": {"solver_type": "amgcl", "krylov_type": "bicgstab"}},
    "end": 0.0495,  # the fiftieth step goes beyond it
    "low": (0, 0), "high": (0.4525, 0.1283454545454545), "counts": (90, 26), "body": (0, 18, 0, 22), "points": 9,
    "law": "HenckyMCPlasticPlaneStrain2DLaw",
    "constants": {"DENSITY": 2600, "YOUNG_MODULUS": 0.84e6, "POISSON_RATIO": 0.3, "COHESION": 0,
                  "INTERNAL_FRICTION_ANGLE": math.radians(31), "INTERNAL_DILATANCY_ANGLE": math.radians(1)},
    "held": {"Wall": (0, [True, False, True]), "Floor": (1, [True, True, True])}}
CANTILEVER = {
    "solver": {"solver_type": "Static", "time_stepping": {"time_step": 1.1}},
    "end": 1.0,
    "low": (0, -1.5), "high": (8.5, 1.5), "counts": (272, 96), "body": (0, 256, 48, 80), "points": 4,
    "law": "HyperElasticNeoHookeanPlaneStrain2DLaw",
    "constants": {"DENSITY": 1000, "YOUNG_MODULUS": 90e6, "POISSON_RATIO": 0},
    "held": {"Wall": (0, [True, True, True])}}
CASES = {"column": COLUMN, "cantilever": CANTILEVER}


def block(kind, rows):
    return "\n".join([f"Begin {kind}", *rows, "End " + kind.split()[0], ""])


def part(name, nodes, elements):
    text = [f"  Begin SubModelPart{k}\n" + "\n".join(map(str, ids)) + f"\n  End SubModelPart{k}"
            for k, ids in (("Nodes", nodes), ("Elements", elements), ("Conditions", []))]
    return block(f"SubModelPart {name}", text)


def mesh(case, cells, element, name, first):
    """Cells i0, i1, j0, j1 of the case's lattice as .mdpa, numbers from `first` on; and the nodes with their places."""
    size = [(case["high"][d] - case["low"][d]) / case["counts"][d] for d in (0, 1)]
    i0, i1, j0, j1 = cells
    width = i1 - i0 + 1

    def node(i, j):
        return first + (j - j0) * width + i - i0

    places = {node(i, j): (case["low"][0] + i * size[0], case["low"][1] + j * size[1])
              for j in range(j0, j1 + 1) for i in range(i0, i1 + 1)}
    corners = [(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))
               for j in range(j0, j1) for i in range(i0, i1)]
    numbers = range(first, first + len(corners))
    text = "Begin ModelPartData\nEnd ModelPartData\nBegin Properties 0\nEnd Properties\n"
    text += block("Nodes", [f"{k} {x:.16g} {y:.16g} 0" for k, (x, y) in places.items()])
    text += block(f"Elements {element}", [f"{k} 0 {a} {b} {c} {d}" for k, (a, b, c, d) in zip(numbers, corners)])
    return text + part(name, places, numbers), places


def held(case):
    return [{"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics",
             "Parameters": {"model_part_name": f"Background_Grid.{name}", "variable_name": "DISPLACEMENT",
                            "constrained": axes, "value": [0, 0, 0], "interval": [0, "End"]}}
            for name, (_, axes) in case["held"].items()]


def parameters(case):
    solver = {"model_part_name": "MPM_Material", "domain_size": 2, "echo_level": 0, "analysis_type": "non_linear",
              "model_import_settings": {"input_type": "mdpa", "input_filename": "Body"},
              "grid_model_import_settings": {"input_type": "mdpa", "input_filename": "Grid"},
              "material_import_settings": {"materials_filename": "Materials.json"},
              "convergence_criterion": "residual_criterion", "residual_relative_tolerance": 1e-6,
              "residual_absolute_tolerance": 1e-9, "max_iteration": 25, "pressure_dofs": False,
              "problem_domain_sub_model_part_list": ["Body", "Grid"],
              "processes_sub_model_part_list": list(case["held"])}
    gravity = {"python_module": "assign_gravity_to_material_point_process",
               "process_name": "AssignGravityToMaterialPointProcess",
               "kratos_module": "KratosMultiphysics.MPMApplication",
               "Parameters": {"model_part_name": "MPM_Material", "variable_name": "MP_VOLUME_ACCELERATION",
                              "modulus": 9.81, "direction": [0.0, -1.0, 0.0]}}
    return {"problem_data": {"problem_name": "bench", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                             "end_time": case["end"]},
            "solver_settings": {**solver, **case["solver"]},
            "processes": {"constraints_process_list": held(case), "loads_process_list": [], "list_other_processes": [],
                          "gravity": [gravity]},
            "analysis_stage": "KratosMultiphysics.MPMApplication.mpm_analysis"}


def materials(case):
    return {"properties": [{"model_part_name": "Initial_MPM_Material.Body", "properties_id": 1, "Material": {
        "constitutive_law": {"name": case["law"]}, "Tables": {},
        "Variables": {"THICKNESS": 1.0, "MATERIAL_POINTS_PER_ELEMENT": case["points"], **case["constants"]}}}]}


def write(case, folder):
    nx, ny = case["counts"]
    grid, places = mesh(case, (0, nx, 0, ny), "Element2D4N", "Grid", 1)
    for name, (axis, _) in case["held"].items():
        grid += part(name, [k for k, x in places.items() if x[axis] == 0], [])
    body, _ = mesh(case, case["body"], "MPMUpdatedLagrangian2D4N", "Body", len(places) + 1)
    for name, text in (("Grid.mdpa", grid), ("Body.mdpa", body),
                       ("Materials.json", json.dumps(materials(case), indent=1)),
                       ("ProjectParameters.json", json.dumps(parameters(case), indent=1))):
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(text)


def run(word):
    os.environ["OMP_NUM_THREADS"] = "1"
    try:
        import KratosMultiphysics as kratos
        import KratosMultiphysics.MPMApplication as mpm
        from KratosMultiphysics.MPMApplication.mpm_analysis import MPMAnalysis
    except ImportError:
        print("not installed: pip install KratosMPMApplication")
        return
    kratos.Logger.GetDefaultOutput().SetSeverity(kratos.Logger.Severity.WARNING)
    model = kratos.Model()
    with open("ProjectParameters.json", encoding="ascii") as file:
        analysis = MPMAnalysis(model, kratos.Parameters(file.read()))
    analysis.Initialize()
    start = time.process_time()
    analysis.RunSolutionLoop()
    seconds = time.process_time() - start
    body, process = model["MPM_Material"], model["Background_Grid"].ProcessInfo

    def of_points(variable):
        return [e.CalculateOnIntegrationPoints(variable, process)[0] for e in body.Elements]

    places, ways = of_points(mpm.MP_COORD), of_points(mpm.MP_DISPLACEMENT)
    answer = f"front {max(x[0] for x in places):.6f}"
    if word == "cantilever":  # of the point that was nearest to the middle of the end
        tip = min(zip(places, ways), key=lambda p: math.hypot(p[0][0] - p[1][0] - 8, p[0][1] - p[1][1] - 0.5))
        answer = f"tip {tip[1][1]:.6f}"
    print(f"{len(places)} points, {process[kratos.STEP]} steps, {seconds:.4f} s of a core, {answer} m")


def main():
    word = sys.argv[1]
    if len(sys.argv) > 2:
        os.makedirs(sys.argv[2], exist_ok=True)
        write(CASES[word], sys.argv[2])
        return
    with tempfile.TemporaryDirectory() as folder:
        write(CASES[word], folder)
        os.chdir(folder)
        run(word)


if __name__ == "__main__":
    main()
