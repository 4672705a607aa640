# Makes the terrain of this case: a slope of 35 degrees with a winding channel, which ends on a plain, and the
# surface of the mass that lies on it.
#   awk -v what=bed -f terrain.awk > bed.asc; awk -v what=top -f terrain.awk > top.asc
function bed(x, y,    slope, channel) {
  slope = 0.35 * (70 - x + sqrt((70 - x)^2 + 15^2))
  channel = (y - middle(x))^2 / 60 / (1 + exp((x - 75) / 8))
  return slope + channel
}
function middle(x) { return 30 + 6 * sin(x / 25) }
function thickness(x, y) { return 5 * (1 - ((x - 20) / 12)^2 - ((y - middle(x)) / 9)^2) }
BEGIN {
  print "ncols 71\nnrows 31\nxllcenter 0\nyllcenter 0\ncellsize 2\nNODATA_value -9999"
  for (y = 60; y >= 0; y -= 2) {
    row = ""
    for (x = 0; x <= 140; x += 2) {
      t = thickness(x, y)
      row = row (x ? " " : "") (what == "bed" ? sprintf("%.2f", bed(x, y)) : t > -3 ? sprintf("%.2f", bed(x, y) + t) : -9999)
    }
    print row
  }
}
