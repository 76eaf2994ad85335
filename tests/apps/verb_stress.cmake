# SPDX-License-Identifier: BSD-3-Clause
app_test(stress_writes_tables_curves_and_pictures [=[
  works stress -o s --axes splat-narrow
  writes s/stress.json s/stress.csv s/stress.md s/splat-narrow.png s/splat-narrow.svg s/splat-narrow-before.png
  prints '^splat-narrow +times +ours '
  is "$(grep -c '^splat-narrow,' s/stress.csv)" -eq 24
  grep -q 'Violations' s/stress.md
  is "$(ls s | grep -c partial)" -eq 0]=])
app_test(stress_refuses_other_axes_and_sizes [=[
  fails 2 'axes.*depth-noise' stress -o s --axes gravity
  fails 2 'size' stress -o s --size huge
  fails 2 'output' stress]=])
