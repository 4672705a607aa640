#!/bin/sh
# Meshes that cannot be used: said with the file's name (and its line where that helps), exit code 2, nothing written. And
# one in millimetres, that can.
. "$(dirname "$0")/library.sh"

cat >case.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {mesh: plate.msh}
bodies:
  - {name: plate, region: soil, points_per_cell: 4, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
boundary:
  - {on: {boundary: wall}, fix: [x, y]}
measures:
  tip: {displacement: y, of: {tracer: [2, 1]}}
END

# Two squares; $1 is a sed expression that spoils them.
plate() {
  cat <<'END' | sed "$1"
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "wall"
2 2 "soil"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
3
1 1 2 1 1 1 4
2 3 2 2 2 1 2 5 4
3 3 2 2 2 2 3 6 5
$EndElements
END
}

# refused NAME SED-EXPRESSION TEXT...: the plate with a change.
refused() {
  what=$1
  plate "$2" >plate.msh
  shift 2
  check "$what" "$@"
}

# check NAME TEXT...: what stands there is refused with these texts.
check() {
  what=$1
  shift
  expect "$what" 2 "$talus" run case.yaml --out result
  says err.txt "$@"
  [ ! -e result ] || fail "$what: something was written"
  rm -rf result
}

plate '' >plate.msh
expect "good mesh" 0 "$talus" run case.yaml --out good --quiet
mv plate.msh metres.msh
plate '/^[1-6] [0-2] [01] 0/s/ \([12]\)/ \1000/g' >plate.msh
for ranks in 1 2; do
  expect "a mesh in mm, $ranks" 0 on_ranks $ranks "$talus" run case.yaml --out mm --force --quiet --set grid.scale=0.001
  cmp -s good/history.csv mm/history.csv || [ $ranks = 2 ] || fail "$name: $(cat mm/history.csv)"
  tip=$(tail -n 1 good/history.csv | cut -d, -f3)
  tail -n 1 mm/history.csv | awk -F, -v tip="$tip" '{exit !(($3 - tip) ^ 2 < 1e-20)}' || fail "$name: $(tail -n 1 mm/history.csv) for $tip"
done
body='bodies[0]={name: plate, mesh: plate.msh, scale: 0.001, region: soil, points_per_cell: 4, material: rubber}'
expect "a body's mesh in mm" 0 "$talus" check case.yaml --set method=mpm --set 'grid={box: {min: [0, 0], max: [3, 2]}, size: 0.5}' --set "$body" --set 'boundary[0].on={x: 0}'
says out.txt "scale: 0.001" "volume 2 m3"
expect "a scale of no mesh" 2 "$talus" check case.yaml --set 'grid={box: {min: [0, 0], max: [3, 2]}, size: 0.5, scale: 2}'
says err.txt "key 'scale' of grid means something only beside 'mesh'"
refused "inverted cell" 's/^3 3 2 2 2 2 3 6 5/3 3 2 2 2 2 6 3 5/' "plate.msh" "cell"
refused "flat cell" 's/^6 2 1 0/6 1.5 0.5 0/' "plate.msh"
refused "unknown node" 's/^3 3 2 2 2 2 3 6 5/3 3 2 2 2 2 3 66 5/' "plate.msh" "element 3 names node 66"
refused "half a mesh" '/^3 3 2/,$d' "plate.msh"
refused "no number" 's/^5 1 1 0/5 1 one 0/' "plate.msh:15" "one"
refused "nan" 's/^5 1 1 0/5 1 nan 0/' "plate.msh:15"
refused "no cells" '/^[23] 3/d; s/^3$/1/' "plate.msh"
refused "another format" 's/^2.2 0 8/9.9 0 8/' "plate.msh:2" "9.9"
head -c 500 "$talus" >plate.msh
check "binary" "plate.msh"
: >plate.msh
check "empty mesh" "plate.msh"
rm plate.msh
check "no mesh" "case.yaml:4:14: error: " "plate.msh"
mkdir plate.msh
check "mesh is a directory" "plate.msh" "not a file"
rmdir plate.msh
for kind in fifo link; do
  if [ $kind = fifo ]; then mkfifo plate.msh; else ln -s /dev/zero plate.msh; fi
  check "a mesh without an end: $kind" "case.yaml:4:14: error: " "plate.msh': this is a pipe or a device, not a file"
  rm plate.msh
done
mkfifo pipe.yaml
expect "a pipe as case" 2 timeout 20 "$talus" run pipe.yaml --out result
says err.txt "pipe.yaml: error: this is no plain file"
plate '' >plate.msh
refused "second order" 's/^3 3 2 2 2 2 3 6 5/3 16 2 2 2 2 3 6 5 1 2 4 5/' "plate.msh:22: element 3 is a second-order quadrilateral" "mesh with Mesh.ElementOrder = 1"
plate '' >plate.msh
cp case.yaml good.yaml
sed 's/region: soil/region: soyl/' good.yaml >case.yaml
check "unknown region" "case.yaml:6:27: error: " "'soyl'" "did you mean 'soil'?"
sed 's/boundary: wall/boundary: wal/' good.yaml >case.yaml
check "unknown boundary" "case.yaml:10:" "'wal'" "did you mean 'wall'?"
sed 's/plane-strain/axisymmetric/' good.yaml >case.yaml
plate 's/^\([14]\) 0 \([01]\) 0/\1 -1 \2 0/' >plate.msh
check "a mesh across the axis" "case.yaml:4:14: error: the mesh crosses the axis x = 0: x is the radius, but its nodes go from x = -1 to 2" \
  "hint: mesh the half of the section with x >= 0"
plate '' >plate.msh
printf 'Point(1) = {0, 0, 0;\n' >wrong.geo
sed 's/plate.msh/wrong.geo/' good.yaml >case.yaml
check "wrong geo" "wrong.geo"
mkfifo pipe.geo
sed 's/plate.msh/pipe.geo/' good.yaml >case.yaml
check "a pipe as script" "pipe.geo': this is a pipe or a device, not a file"

# What gmsh says, how it ends, and no name that nobody knows
cp case.yaml script.yaml
mkdir bin && export PATH="$work/bin:$PATH"
# gmsh_does COMMANDS: from now on gmsh is this.
gmsh_does() { printf '#!/bin/sh\nfor i in 1 2 3 4 5; do echo "Info    : banner $i"; done\n%s\n' "$1" >bin/gmsh && chmod +x bin/gmsh; }
printf 'Point(1) = {0, 0, 0};\n' >wrong.geo
sed 's/plate.msh/wrong.geo/' good.yaml >case.yaml
gmsh_does 'echo "Info    : last words"; echo "Info    : Writing $4"; kill -SEGV $$'
check "gmsh crashes" "gmsh could not mesh '" "wrong.geo', it was killed by signal 11 (Segmentation fault): banner 4; banner 5; last words"
lacks err.txt "banner 1" ".msh"
gmsh_does 'exit 7'
check "gmsh gives up" "wrong.geo', it ended with code 7: banner 3; banner 4; banner 5"
gmsh_does 'echo "Error   : this went wrong"; echo "Info    : more"; exit 1'
check "gmsh complains" "wrong.geo', it ended with code 1: this went wrong"
lacks err.txt "banner" "more"
gmsh_does ''
check "gmsh makes nothing" "the mesh that gmsh made of '$work/wrong.geo'" "the file is empty"
lacks err.txt ".msh"
gmsh_does 'printf "\$MeshFormat\n4.1 0 8\n\$EndMeshFormat\n\$Nodes\nx\n" >"$4"'
check "gmsh makes nonsense" "the mesh that gmsh made of '$work/wrong.geo':5: an integer was expected"
rm -r bin

# Found by fuzzing: a dimension that asks for 1e18 parameters of each node, though the file has ended. It took for ever.
cp good.yaml case.yaml
printf '$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n999999999999999999 1 1 1\n1\n0 0 0\n$EndNodes\n' >plate.msh
check "a block of many dimensions" "plate.msh" "a block of nodes has dimension 999999999999999999"

finish
