#!/bin/sh
# talus import kratos: projects as Kratos's users write them, made here, with answers that are known without any program.
. "$(dirname "$0")/library.sh"

# settings TYPE STEP END: ProjectParameters.json up to its processes.
settings() {
  cat <<END
{"problem_data": {"problem_name": "bar", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": $3, "echo_level": 0},
 "solver_settings": {
	"solver_type": "$1", "model_part_name": "MPM_Material", "domain_size": 2, "scheme_type": "newmark",
	"time_integration_method": "implicit", "pressure_dofs": false,
	"model_import_settings": {"input_type": "mdpa", "input_filename": "somewhere/bar_Body"},
	"grid_model_import_settings": {"input_type": "mdpa", "input_filename": "bar_Grid"},
	"material_import_settings": {"materials_filename": "ParticleMaterials.json"},
	"time_stepping": {"time_step": $2}},
END
}

materials() { # LAW
  cat <<END
{"properties": [{"model_part_name": "Initial_MPM_Material.Bar", "properties_id": 1, "Material": {
  "constitutive_law": {"name": "$1"},
  "Variables": {"THICKNESS": 1.0, "PARTICLES_PER_ELEMENT": 4, "DENSITY": 1000, "YOUNG_MODULUS": 1e6, "POISSON_RATIO": 0,
    "INTERNAL_FRICTION_ANGLE": 0.5235987755982988, "INTERNAL_DILATANCY_ANGLE": 0.0, "COHESION": 10},
  "Tables": {}}}]}
END
}

# A bar of two cells, 2 m by 1 m, which is its own grid: held at its left end, pulled at the right one.
meshes() {
  nodes='Begin Nodes
    1  0.0 0.0 0.0
    2  1.0 0.0 0.0
    3  2.0 0.0 0.0
   11  0.0 1.0 0.0
   12  1.0 1.0 0.0
   13  2.0 1.0 0.0
End Nodes'
  cat >bar_Body.mdpa <<END
Begin ModelPartData
//  VARIABLE_NAME value
End ModelPartData
Begin Properties 0
End Properties
$nodes
Begin Elements UpdatedLagrangian2D4N// GUI group identifier: Parts
    1  0  1 2 12 11
    2  0  2 3 13 12
End Elements
Begin SubModelPart Bar // Group Parts
    Begin SubModelPartNodes
        1
        2
        3
        11
        12
        13
    End SubModelPartNodes
    Begin SubModelPartElements
        1
        2
    End SubModelPartElements
    Begin SubModelPartConditions
    End SubModelPartConditions
End SubModelPart
END
  cat >bar_Grid.mdpa <<END
$nodes
Begin Elements Element2D4N
    1  0  1 2 12 11
    2  0  2 3 13 12
End Elements
Begin Conditions MPMGridLineLoadCondition2D2N
    1  0  3 13
End Conditions
Begin SubModelPart Wall
    Begin SubModelPartNodes
        1
        11
    End SubModelPartNodes
End SubModelPart
Begin SubModelPart Right-hand
  Begin SubModelPart End
    Begin SubModelPartNodes
        3
        13
    End SubModelPartNodes
    Begin SubModelPartConditions
        1
    End SubModelPartConditions
  End SubModelPart
End SubModelPart
END
}

held='{"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "Parameters": {
   "model_part_name": "Background_Grid.Wall", "variable_name": "DISPLACEMENT", "constrained": [true, true, true],
   "value": [0.0, 0.0, 0.0], "interval": [0.0, "End"]}}'
load='{"python_module": "assign_vector_by_direction_to_condition_process", "Parameters": {
   "model_part_name": "Background_Grid.Right-hand.End", "variable_name": "LINE_LOAD", "modulus": 1.0, "direction": [2.0, 0.0, 0.0],
   "interval": [0.0, "End"]}}'
gravity='{"python_module": "assign_gravity_to_particle_process", "Parameters": {
   "model_part_name": "MPM_Material", "variable_name": "MP_VOLUME_ACCELERATION", "modulus": 10, "direction": [0.0, -1.0, 0.0]}}'
checks() { # MODULE VARIABLE
  echo '{"python_module": "'$1'", "Parameters": {"check_variables": ['$2'], "input_file_name": "results.json", "model_part_name": "x"}}'
}

# A bar of E = 1e6 Pa pulled by 1 Pa: 2e-6 m at its end, sigma_xx = 1 Pa; in two steps with all of the load in both.
mkdir pulled && cd pulled || exit 1
meshes
materials LinearElasticIsotropicPlaneStrain2DLaw >ParticleMaterials.json
{ settings Static 1.5 2.0
  echo "\"processes\": {\"constraints\": [$held], \"loads\": [$load], \"other\": [
    $(checks from_json_check_result_process '"DISPLACEMENT"'), $(checks particle_from_json_check_result_process '"MP_CAUCHY_STRESS_VECTOR"')]}}"
} >ProjectParameters.json
cat >results.json <<'END'
{"TIME": [1.5, 3.0], "NODE_3": {"DISPLACEMENT_X": [2e-6, 2e-6], "DISPLACEMENT_Y": [1e-20, 0]}, "NODE_13": {"DISPLACEMENT_X": [1e-6, 1e-6]},
 "PARTICLE_14": {"MP_CAUCHY_STRESS_VECTOR": [[1, 0, 0], [1.5, 1e-20, 0]]}, "PARTICLE_15": {"MP_CAUCHY_STRESS_VECTOR": [[1, 0, 0], [0.5, 0, 0]]}}
END
cd .. || exit 1
expect "a bar that is pulled" 0 "$talus" import kratos pulled --out bar
says out.txt "bar/case.yaml" "talus run bar/case.yaml"
says err.txt "LinearElasticIsotropicPlaneStrain2DLaw is taken as neo-hookean"
says bar/case.yaml "analysis: {type: static, end: 3, steps: 2}" "on: {boundary: Right_hand_End}, value: [1, 0], amplitude: [[0, 1], [3, 1]]" "fix: [x, y]" \
  "displacement_x_node_3: {displacement: x, of: {tracer: [2, 0]}}" "stress_xx: {stress: xx}" "points_per_cell: 4"
lacks bar/case.yaml "displacement_y"
expect "check" 0 "$talus" check bar/case.yaml
says out.txt "8 points in 2 cells, volume 2 m3, mass 2000 kg"
expect "run" 0 "$talus" run bar/case.yaml
says out.txt "4 of 4 within what is allowed"
expect "run on two ranks" 0 on_ranks 2 "$talus" run bar/case.yaml --force
says out.txt "4 of 4 within what is allowed"
expect "again" 2 "$talus" import kratos pulled --out bar
says err.txt "the folder 'bar' cannot be made: File exists"

# The load as a formula of places: x^2 - 3 is 1 where it acts.
cp -r pulled formula
sed -i 's/"modulus": 1.0/"modulus": "x**2 - 3"/' formula/ProjectParameters.json
materials LinearElasticPlaneStrain2DLaw >formula/ParticleMaterials.json
expect "a load by a formula" 0 "$talus" import kratos formula --out varying
says varying/case.yaml 'value: [1, 0], amplitude: [[0, 1], [3, 1]], factor: "x^2 - 3"'
expect "it pulls as much" 0 "$talus" run varying/case.yaml
says out.txt "4 of 4 within what is allowed"

# A formula of time is of Kratos's time, which begins with start_time: 1 where 100 t - 50 acts at t = 0.51, and so are the times of
# results and of intervals.
sed 's/"start_time": 0.0/"start_time": 0.5/; s/"end_time": 2.0/"end_time": 0.51/; s/"time_step": 1.5/"time_step": 0.01/
  s/"interval": \[0.0,/"interval": [0.5,/; s/"modulus": "x\*\*2 - 3"/"modulus": "100*t - 50 + 0*sqrt(X)"/' formula/ProjectParameters.json >formula/late.json
sed 's/\[1.5, 3.0\]/[0.505, 0.51]/; s/\[2e-6, 2e-6\]/[1e-6, 2e-6]/; s/\[1e-6, 1e-6\]/[5e-7, 1e-6]/' formula/results.json >formula/late_results.json
sed -i 's/results.json/late_results.json/' formula/late.json
expect "a start that is not 0" 0 "$talus" import kratos formula/late.json --out late
says late/case.yaml 'end: 0.01, steps: 1}' 'factor: "100*(t + 0.5) - 50 + 0*sqrt(X)"'
says late/reference.yaml "at: 0.01, reference: 2e-06"
expect "it pulls as much" 0 "$talus" run late/case.yaml
sed 's/"interval": \[0.5,/"interval": [0.505,/' formula/late.json >formula/later.json
expect "what begins within the run" 2 "$talus" import kratos formula/later.json --out none
says err.txt "what begins or ends within the run is not read"
sed "s/100\*t - 50/$(printf '1*%.0s' $(seq 130))1/" formula/late.json >formula/long.json
expect "a long formula" 2 "$talus" import kratos formula/long.json --out none
says err.txt "a formula of so many letters is not read"

# Pushed by 2 mm over 2 m along x, and nothing holds it along y: E times the strain; and gravity would take it away.
cp -r pulled pushed
along() { # PART VALUE
  echo "$held" | sed "s/Wall/$1/; s/\[true, true, true\]/[true, false, false]/; s/\[0.0, 0.0, 0.0\]/[$2, 0.0, 0.0]/"
}
checked=$(checks particle_from_json_check_result_process '"MP_CAUCHY_STRESS_VECTOR"')
both="$(along Wall 0.0), $(along Right-hand.End -0.001)"
{ settings Static 1.5 2.0 && echo "\"processes\": {\"a\": [$both], \"b\": [$checked]}}"; } >pushed/ProjectParameters.json
echo '{"TIME": [1.5, 3.0], "PARTICLE_14": {"MP_CAUCHY_STRESS_VECTOR": [[-500, 0, 0], [-1000, 0, 0]]}}' >pushed/results.json
expect "a bar that nothing holds along y" 0 "$talus" import kratos pushed --out push
says err.txt "no part of the grid holds the material in all directions and from turning"
says push/case.yaml "steps: 2, unheld: hold}" "single nodes are held, which bear nothing"
for n in 1 2 3; do
  expect "it has its stress on $n ranks" 0 on_ranks $n "$talus" run push/case.yaml --force
  says out.txt "2 of 2 within what is allowed"
  says err.txt "nothing holds 'Bar' in y: held in 1 direction(s) of nodes, which bear nothing"
done
none=$(echo $gravity | sed 's/"modulus": 10, "direction": .*\]/"modulus": 0.0, "direction": [0.0, 0.0, 0.0]/; s/[\/&]/\\&/g')
sed "s/\"a\": \[/&$none, /" pushed/ProjectParameters.json >pushed/floats.json
expect "gravity of 0, without a direction" 0 "$talus" import kratos pushed/floats.json --out floats
says floats/case.yaml "gravity: [0, 0]"
sed -i "s/\"a\": \[/&$(echo $gravity | sed 's/[\/&]/\\&/g'), /" pushed/ProjectParameters.json
expect "and has weight" 0 "$talus" import kratos pushed --out weight
expect "which nothing bears" 2 "$talus" check weight/case.yaml
says err.txt "nothing holds 'Bar' in y, and loads push it that way: 2e+04 of 2e+04 N are out of balance"

# A file by another name; what falls freely: g t^2 / 2 and g t, exact for steps of Newmark's; angles in radians.
cp -r pulled falling
{ settings Dynamic 0.01 0.05
  echo "\"processes\": {\"gravity\": [$gravity], \"other\": [$(checks particle_from_json_check_result_process '"MP_DISPLACEMENT", "MP_VELOCITY", "MP_SPIN"')]}}"
} >falling/fall.json
rm falling/ProjectParameters.json
materials HenckyMCPlasticPlaneStrain2DLaw >falling/ParticleMaterials.json
cat >falling/results.json <<'END'
{"TIME": [0.02, 0.05], "PARTICLE_14": {"MP_DISPLACEMENT_Y": [-0.002, -0.0125], "MP_VELOCITY_Y": [-0.2, -0.5]}}
END
expect "the name of the problem is there" 2 "$talus" import kratos falling/fall.json
says err.txt "the folder 'bar' cannot be made" "MP_SPIN is not compared: talus has no measure for it"
says bar/case.yaml "neo-hookean"
expect "a bar that falls" 0 "$talus" import kratos falling/fall.json --out fall
says fall/case.yaml "type: dynamic, end: 0.05, step: 0.01, mass: lumped, transfer: thesis}" "law: mohr-coulomb" "friction_angle: 30" "gravity: [0, -10]"
expect "it falls" 0 "$talus" run fall/case.yaml
says out.txt "4 of 4 within what is allowed"

# Gravity and velocities are modulus times direction as it stands (and 1 where there is no modulus); a load's direction has length 1.
cp -r falling thrown
thrown=$(echo "$gravity" | sed 's/gravity_to_particle/initial_velocity_to_material_point/; s/"modulus": 10, "direction": .*\]/"direction": [2.0, 0.0, 0.0]/')
{ settings Dynamic 0.01 0.05
  echo "\"processes\": {\"gravity\": [$(echo "$gravity" | sed 's/-1.0/-3.0/')], \"start\": [$thrown], \"loads\": [$load]}}"
} >thrown/throw.json
expect "directions that are no unit vectors" 0 "$talus" import kratos thrown/throw.json --out throw
says throw/case.yaml "gravity: [0, -30]" "velocity: [2, 0]" "on: {boundary: Right_hand_End}, value: [1, 0]"

# What moves in dynamics moves by as much in each step: half of it after half of the time.
both="$(along Wall 0.0), $(along Right-hand.End -0.001)"
{ settings Dynamic 0.01 0.04
  echo "\"processes\": {\"a\": [$both], \"b\": [$(checks particle_from_json_check_result_process '"MP_DISPLACEMENT"')]}}"
} >falling/moved.json
expect "a bar that is pushed in dynamics" 0 "$talus" import kratos falling/moved.json --out moved
says moved/case.yaml "displacement: {x: -0.004}, amplitude: [[0, 0], [0.04, 1]]}"
expect "no jump" 0 "$talus" check moved/case.yaml
lacks err.txt "jumps"

# Kratos's default in dynamics is Bossak's scheme.
sed 's/"scheme_type": "newmark"/"echo_level": 0/' falling/fall.json >falling/bossak.json
expect "Bossak" 0 "$talus" import kratos falling/bossak.json --out bossak
says bossak/case.yaml "bossak: -0.3, mass: lumped, transfer: thesis}"
sed -i 's/"echo_level": 0,$/"echo_level": 0, "consistent_mass_matrix": true,/' falling/bossak.json
expect "consistent mass" 0 "$talus" import kratos falling/bossak.json --out mass
lacks mass/case.yaml "mass: lumped"

# Plane stress has plane strain's constants; ten steps of 0.1 s, added up, are less than 1 s, and Kratos takes an eleventh.
materials LinearElasticIsotropicPlaneStress2DLaw | sed 's/"POISSON_RATIO": 0/"POISSON_RATIO": 0.25/' >falling/ParticleMaterials.json
sed 's/"end_time": 0.05/"end_time": 1.0/; s/"time_step": 0.01/"time_step": 0.1/' falling/bossak.json >falling/stress.json
expect "plane stress" 0 "$talus" import kratos falling/stress.json --out stress
says err.txt "plane stress is taken as plane strain with"
says stress/case.yaml "young: 960000, poisson: 0.2}" "end: 1.1, step: 0.1"
materials HyperElasticNeoHookeanPlaneStress2DLaw >falling/ParticleMaterials.json
expect "plane stress of rubber" 2 "$talus" import kratos falling/stress.json --out none
says err.txt "plane stress only of the linear elastic law"

# All that is refused, at once, with its place; nothing is written.
cp -r pulled odd
materials JohnsonCookThermalPlastic2DPlaneStrainLaw >odd/ParticleMaterials.json
{ settings Dynamic 0.01 0.05 | sed 's/"implicit"/"explicit"/; s/"pressure_dofs"/"contact_settings": {}, "pressure_dofs"/'
  echo '"processes": {"a": [{"python_module": "apply_mpm_particle_dirichlet_condition_process", "Parameters": {}}],'
  echo "\"b\": [$(echo "$held" | sed 's/"End"/0.02/'), $(echo "$held" | sed 's/Grid.Wall/Grid.Floor/'), $(echo "$held" | sed 's/\[0.0, 0.0, 0.0\]/["10*t", 0, 0]/')],"
  echo "\"c\": [$(echo "$load" | sed 's/LINE_LOAD/FACE_PRESSURE/'), $(echo "$load" | sed 's/2.0, 0.0, 0.0/0, 0, 0/')]}}"
} >odd/ProjectParameters.json
expect "what talus lacks" 2 "$talus" import kratos odd --out none
says err.txt "talus is implicit: explicit integration is not read" "talus has nothing for the process 'apply_mpm_particle_dirichlet_condition_process'" \
  "what begins or ends within the run is not read" "has no model part 'Floor'" "functions of time and place are not read" \
  "a load by FACE_PRESSURE is not read" "a direction of three numbers, not all 0" "talus has no law like 'JohnsonCookThermalPlastic2DPlaneStrainLaw'" \
  "odd/ProjectParameters.json:4:" "odd/ParticleMaterials.json:2:" "solver_settings.contact_settings is left out"
[ ! -e none ] || fail "$name: a folder is left"

sed -i 's/x\*\*2 - 3/x if t < 1 else 0/' formula/ProjectParameters.json
expect "what talus lacks in formulas" 2 "$talus" import kratos formula --out none
says err.txt "the formula 'x if t < 1 else 0' is not read from 'if t < 1 else 0' on"

# Meshes that are none
wrong() { # TEXT-OF-SED MESSAGE
  cp pulled/bar_Grid.mdpa whole.mdpa
  sed "$1" whole.mdpa >pulled/bar_Grid.mdpa
  expect "a mesh with $1" 2 "$talus" import kratos pulled --out none
  says err.txt "bar_Grid.mdpa" "$2"
  cp whole.mdpa pulled/bar_Grid.mdpa
}
wrong 's/2 3 13 12/2 3 14 12/' "a node that the file has is expected, not '14'"
wrong 's/2 3 13 12/2 3 13/' "a number of a node or element is expected, not 'End'"
wrong 's/^    2  1.0 0.0/    2  one 0.0/' "a coordinate is expected, not 'one'"
wrong 's/^End Elements/End Nodes/' "a block ends with another name than it began with, not 'Nodes'"
wrong '/^End Conditions/,$d' "the end of the file"
wrong 's/Element2D4N/Quadrilateral/' "a type that ends with its number of nodes"
wrong 's/Begin Nodes/Nodes/' "the begin of a block is expected, not 'Nodes'"
wrong 's/^   13 /   999999999999 /' "a number of a node or element is expected"
wrong '/^Begin Nodes/,/^End Nodes/d' "a node that the file has is expected, not '1'"
wrong '/^Begin SubModelPart Wall/,$d' "has no model part 'Wall'"
wrong 's/^Begin SubModelPart Wall/& Begin SubModelPart Wall/' "a block ends with another name than it began with"
for depth in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18; do echo "Begin SubModelPart P$depth"; done >deep.mdpa
wrong '$r deep.mdpa' "parts are not that deep in each other"
: >pulled/ProjectParameters.json
expect "an empty file" 2 "$talus" import kratos pulled --out none
expect "no project" 2 "$talus" import kratos nowhere --out none
says err.txt "cannot be read"
expect "another program" 2 "$talus" import abaqus pulled
says err.txt "projects of 'abaqus' are not read"

finish
