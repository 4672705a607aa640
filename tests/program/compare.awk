# awk -f compare.awk A.csv B.csv: do two histories agree? Relative to the largest value of each column, to 1e-9.
BEGIN { FS = "," }
FNR == 1 { ++file; if (file == 1) header = $0; else if ($0 != header) { print "other columns: " $0; bad = 1 }; n = split($0, title, ","); next }
file == 1 { for (k = 1; k <= NF; ++k) { a[FNR, k] = $k; v = $k < 0 ? -$k : $k + 0; if (v > scale[k]) scale[k] = v }; rows = FNR; next }
{
  seen = FNR
  if (NF != n) { print "row " FNR " has " NF " columns"; bad = 1 }
  for (k = 1; k <= NF; ++k) {
    d = $k - a[FNR, k]
    if (d < 0) d = -d
    if (!(d <= 1e-9 * scale[k])) { print title[k] " at t = " $1 ": " a[FNR, k] " and " $k; bad = 1 }
  }
}
END { if (seen != rows || rows < 2) { print rows " and " seen " rows"; bad = 1 }; exit bad }
