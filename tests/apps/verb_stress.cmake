# SPDX-License-Identifier: BSD-3-Clause
app_test(stress_writes_tables_curves_and_pictures [=[
  mkdir s
  touch s/depth-noise.png s/depth-noise-after.png s/rotation.svg s/mine.png
  works stress -o s --axes splat-narrow
  says '^s: 1 axis put under stress in '
  is "$(LC_ALL=C ls s | xargs)" = "mine.png splat-narrow-before.png splat-narrow-others.png splat-narrow.png splat-narrow.svg stress.csv stress.json stress.md"
  writes s/stress.json s/stress.csv s/stress.md s/splat-narrow.png s/splat-narrow.svg s/splat-narrow-before.png s/splat-narrow-others.png
  prints '^splat-narrow +times +ours '
  is "$(grep -c '^splat-narrow,' s/stress.csv)" -eq 24
  grep -q 'Violations' s/stress.md
  grep -q '"data": "rooms"' s/stress.json
  grep -q '^splat-narrow,"ours, no guard",32,[0-9.]*$' s/stress.csv
  grep -q '^| splat-narrow | times | PSNR of a view left out is under 16 dB | ' s/stress.md
  is "$(ls s | grep -c partial)" -eq 0]=])
app_test(stress_refuses_other_axes_and_sizes [=[
  fails 2 'axes.*depth-noise' stress -o s --axes gravity
  fails 2 'size' stress -o s --size huge
  fails 2 'output' stress]=])
app_test(stress_of_photos_refuses_weights_that_are_not_there [=[
  fails 1 'absent' stress -o s --axes rotation --weights absent]=])
app_test(stress_takes_frames "
  works --threads 1 stress ${PROJECT_SOURCE_DIR}/data/room -o s --axes principal-point,mirror --every 2
  says 'room: left out: mirror .it reflects the walls of a box.$'
  says '^s: 1 axis put under stress in '
  writes s/principal-point.svg s/principal-point-others.png
  is \"$(grep -c '^principal-point,' s/stress.csv)\" -eq 28
  is \"$(grep -c '^ *.000[01][0-9].,*$' s/stress.json)\" -eq 8
  grep -q '\"data\": \".*/data/room\"' s/stress.json
  grep -q '^Where each method breaks on .*/data/room, one thing' s/stress.md")
app_test(stress_says_where_ours_jumps [=[
  works --threads 1 stress rooms:5:4 -o s --axes depth-bias
  says '^note: depth-bias: ours gets worse at once from 4 .[0-9.]*. to 8 .[0-9.]*.$'
  grep -q '^- depth-bias: jump towards 8' s/stress.md
  works --threads 1 -q stress rooms:5:4 -o s --axes depth-bias
  is ! -s "$work/err"]=])
app_test(stress_refuses_frames_that_are_too_few_or_have_no_depth [=[
  fails 1 'absent' stress absent -o s
  fails 1 'no world has three frames' stress rooms:5:2 -o s --axes exposure
  fails 1 'no two frames' stress rooms:5:1 -o s --axes photo-noise
  fails 1 'translation .it moves the camera at will.; expected other --axes' stress rooms:5:4 -o s --axes translation
  fails 1 'no frame is in' stress rooms:5:4 -o s --frames 90:99
  cp -r $S/estate e
  sed -i '$s/ 1 0 0 0 0 1 0 0 0 0 1 0$/ 0.8660254 0 0.5 0 0 1 0 0 -0.5 0 0.8660254 0/' e/clip.txt
  fails 1 'has no depth; expected' stress e -o s --axes photo-noise]=])
