# SPDX-License-Identifier: BSD-3-Clause
app_test(stress_writes_tables_curves_and_pictures [=[
  mkdir s
  touch s/depth-noise.png s/depth-noise-after.png s/rotation.svg s/mine.png
  works stress -o s --axes splat-narrow
  says '^s: 1 axis put under stress in '
  is "$(LC_ALL=C ls s | xargs)" = "mine.png splat-narrow-before.png splat-narrow.png splat-narrow.svg stress.csv stress.json stress.md"
  writes s/stress.json s/stress.csv s/stress.md s/splat-narrow.png s/splat-narrow.svg s/splat-narrow-before.png
  prints '^splat-narrow +times +ours '
  is "$(grep -c '^splat-narrow,' s/stress.csv)" -eq 24
  grep -q 'Violations' s/stress.md
  grep -q '^splat-narrow,"ours, no guard",32,[0-9.]*$' s/stress.csv
  grep -q '^| splat-narrow | times | PSNR of a view left out is under 16 dB | ' s/stress.md
  is "$(ls s | grep -c partial)" -eq 0]=])
app_test(stress_refuses_other_axes_and_sizes [=[
  fails 2 'axes.*depth-noise' stress -o s --axes gravity
  fails 2 'size' stress -o s --size huge
  fails 2 'output' stress]=])
app_test(stress_of_photos_refuses_weights_that_are_not_there [=[
  fails 1 'absent' stress -o s --axes rotation --weights absent]=])
