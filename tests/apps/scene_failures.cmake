# SPDX-License-Identifier: BSD-3-Clause
# `scene` where something is in its way: a full disk, a kill, photos and weights that are not as usual.
app_test(scene_of_a_photo_turned_by_exif_has_the_turned_size [=[
  needs ffprobe
  args="--weights $S/published.safetensors --samples 1 --directions left"
  works scene $S/exif.jpg $args -o lying
  works scene $S/exif_turned.jpg $args -o upright
  is "$(size_of lying/views/left.png)" = 384x256
  for v in input left; do is "$(size_of upright/views/$v.png)" = 256x384; done
  lens() { sed -n '/^  "lens"/,/}/p' $1/report.json | sed -n "s/^ *\"$2\": \(.*[^,]\),*$/\1/p"; }
  is "$(lens upright from)" = '"EXIF"'
  is "$(lens upright width)x$(lens upright height)" = 64x96
  is "$(lens upright fx)" = "$(lens lying fx)"
  is "$(lens upright fy)" = "$(lens lying fx)"
  is "$(lens upright cy)" = "$(lens lying cx)"]=])
# killed_by SIGNAL: begins s, and ends it so when some of its four views are kept, not all.
set(killed "
  args=\"$S/photo.png --fov 70 --samples 8 --directions left,right,up,down\"
  killed_by() {
    env --default-signal=INT $program -q scene $args -o s & pid=$!
    for i in $(seq 600); do
      [ ! -e s.work/1.safetensors ] || break
      sleep 0.05
    done
    kill -$1 $pid
    ! wait $pid 2>/dev/null || complain 'it was not killed'
    is -e s.work/1.safetensors
    is ! -e s.work/4.safetensors
    is ! -e s
  }")
app_test(scene_goes_on_after_a_kill_to_the_same_bytes "${killed}
  works scene $args -o whole
  killed_by KILL
  is \"$(ls -d s.partial-* | wc -l)\" -eq 1
  works scene $args -o s --resume
  grep -q '\"resumed\": true' s/report.json
  diff -r s/views whole/views
  cmp s/scene.ply whole/scene.ply
  is \"$(ls | xargs)\" = 's whole'")
app_test(scene_goes_on_after_a_full_disk_to_the_same_bytes "${killed}
  works scene $args -o whole
  killed_by INT
  cp -r s.work before
  trap '' XFSZ
  (ulimit -f 1000; fails 1 '^pixelsynth: [^ ]*/s.work/[234].safetensors: writing failed: File too large; expected room for it, and leave to write; the same command with --resume goes on' -q scene $args -o s --resume)
  diff -r s.work before
  rm -r before
  ! (ulimit -f 2000; $program -q scene $args -o s --resume 2>$work/err) || complain 'it had room'
  says '^pixelsynth: s/scene.ply: writing failed: File too large; expected room .*--resume goes on'
  is \"$(wc -l <$work/err)\" -eq 1
  is \"$(ls | xargs)\" = 's.work whole'
  is -e s.work/4.safetensors
  is ! -e s
  works scene $args -o s --resume
  is \"$(grep -c '\"resumed\": true' s/report.json)\" -eq 4
  diff -r s/views whole/views
  cmp s/scene.ply whole/scene.ply
  is \"$(ls | xargs)\" = 's whole'")
app_test(scene_on_a_full_disk_from_the_start_leaves_nothing [=[
  trap '' XFSZ
  ulimit -f 1000
  fails 1 's.work/1.safetensors: writing failed: File too large$' -q scene $S/photo.png --fov 70 --samples 1 --directions left -o s]=])
app_test(scene_looks_straight_up_and_behind [=[
  needs ffprobe
  works scene $S/photo.png --fov 70 -o s --samples 1 --directions up --range-vertical 180deg
  is "$(json outpainted s/report.json)" -gt 10000
  is "$(size_of s/views/up.png)" = 384x256
  # Half a turn about x from the photo's camera, itself half a turn from the world: axes are the world's.
  awk '!/^#/ { w = $8 < 0 ? -$8 : $8 } END { exit !(w > 0.999) }' s/trajectory.txt || complain "$(cat s/trajectory.txt)"
  works scene $S/photo.png --fov 70 -o t --samples 1 --directions down --range-vertical 90deg
  is "$(json outpainted t/report.json)" -gt 10000
  fails 2 "'181deg' is no angle" scene $S/photo.png -o u --directions up --range-vertical 181deg]=])
app_test(scene_finds_where_a_second_photo_was_taken [=[
  p="$S/pair" # two views of one room; pose.txt is the truth
  args="scene $p/first.png --depth $p/first_depth.png --intrinsics $p/lens.json --second $p/second.png --second-depth $p/second_depth.png --no-outpaint"
  works $args -o s
  works $args --second-pose $p/pose.txt -o t
  grep -q '"from": "auto"' s/report.json
  is "$(sed -n 's/^ *"inliers": \([0-9]*\).*/\1/p' s/report.json)" -ge 25
  works eval cloud s/scene.ply t/scene.ply --thresholds 0.02 -o e.json
  f=$(grep 'F-score' e.csv | cut -d, -f3)
  awk "BEGIN { exit !($f > 0.95) }" || complain "F-score of the found pose's cloud is $f"
  works scene $p/first.png --depth $p/first_depth.png --intrinsics $p/lens.json --no-outpaint -o one
  is "$(json points s/report.json)" -gt "$(json points one/report.json)"
  works $args --second-pose auto -o again
  cmp again/scene.ply s/scene.ply]=])
app_test(scene_draws_no_more_completions_than_help [=[
  works scene $S/photo.png --fov 70 -o s --directions left
  drawn=$(sed -n 's/^ *"drawn": \([0-9]*\).*/\1/p' s/report.json)
  is $drawn -ge 2
  is $drawn -le 50
  is "$(grep -A2 '"drawn"' s/report.json | sed -n 's/^ *"spared": \([0-9]*\).*/\1/p')" -eq $((50 - drawn))
  grep -q '"samples": "auto"' s/settings.json
  works scene $S/photo.png --fov 70 -o t --samples $drawn --directions left
  cmp t/scene.ply s/scene.ply]=])
app_test(scene_refuses_networks_of_different_numbers_of_codes [=[
  cp -r $S/mixed w
  mv w/more_codes.safetensors w/pixelcnn.safetensors
  fails 1 'w/pixelcnn.safetensors: the autoencoder has 24 codes, the PixelCNN 30; expected networks that were trained together' -q scene $S/photo.png --fov 70 --samples 1 -o s --weights w
  rm w/pixelcnn.safetensors
  fails 1 'w/pixelcnn.safetensors' -q scene $S/photo.png --fov 70 --samples 1 -o s --weights w]=])
app_test(scene_says_what_each_stage_took_in_time_and_memory [=[
  works scene $S/photo.png --fov 70 --weights $S/published.safetensors --samples 1 --directions left -o s
  after() { sed -n '/^  "peak_memory_mib_after"/,/}/p' s/report.json | sed -n "s/^ *\"$1\": \([0-9]*\).*/\1/p"; }
  before=1
  for stage in load_networks read_input observe outpaint budget views write; do
    sed -n '/^  "seconds"/,/}/p' s/report.json | grep -q "\"$stage\": [0-9]" || complain "$stage has no seconds"
    is "$(after $stage)" -ge $before
    before=$(after $stage)
  done
  peak=$(json peak_memory_mib s/report.json)
  is ${peak%.*} -ge $before]=])
# 43 million pixels: 12 bytes each as floats, and 4 more of depth.
app_test(scene_of_a_huge_photo_holds_no_more_of_it_than_it_can_use [=[
  needs ffmpeg
  ffmpeg -v error -i $S/photo.png -vf scale=8000:-1 -frames:v 1 big.jpg
  works scene big.jpg --fov 70 --weights $S/depth.safetensors --no-outpaint --view-size 256 --directions left -o s
  works scene big.jpg --fov 70 --weights $S/depth.safetensors --no-outpaint --view-size 250 --directions left -o t
  grep -A1 '"shrunk_to"' t/report.json | grep -q 500
  grep -A3 '"shrunk_to"' s/report.json | tr -d ' \n' | grep -q '"shrunk_to":.512,341' || complain "it is shrunk to another size"
  is "$(sed -n '/^  "lens"/,/}/p' s/report.json | sed -n 's/^ *"width": \([0-9]*\).*/\1/p')" -eq 8000
  is "$(size_of s/views/input.png)" = 256x171
  peak=$(json peak_memory_mib s/report.json)
  is ${peak%.*} -lt 500]=])
