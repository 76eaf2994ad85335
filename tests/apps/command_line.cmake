# SPDX-License-Identifier: BSD-3-Clause
# What holds for all verbs: exit status, one line for one failure, nothing half-written.
app_test(no_verb_prints_help [=[
  works
  prints 'Subcommands'
  prints 'fuse']=])
app_test(every_verb_has_help [=[for v in scene depth fuse render view chart stress eval "eval depth" "eval cloud" "eval consistency" "eval views" "eval ab" "probe splat" "probe depth" "probe vq-encode" "probe vq-decode" "probe pixelcnn" "probe refine" "probe discriminator" "probe lpips" "probe classifier" weights "weights info" "weights convert"; do works $v --help; prints Options; done]=])
app_test(version_is_printed [=[
  works --version
  prints '^pixelsynth [0-9]+[.][0-9]+[.][0-9]+$']=])
app_test(unknown_verb_is_wrong_usage "fails 2 'frobnicate' frobnicate")
app_test(unknown_option_is_wrong_usage "fails 2 'nonsense.*see pixelsynth fuse --help' fuse $S/walk -o a.ply --nonsense")
app_test(wrong_usage_points_to_the_help_of_the_verb_that_it_is_of [=[
  fails 2 '^pixelsynth eval views: .*nonsense.*see pixelsynth eval views --help$' eval views $S/walk --nonsense
  fails 2 '^pixelsynth eval depth: .*see pixelsynth eval depth --help$' eval depth
  fails 2 '^pixelsynth eval ab: .*see pixelsynth eval ab --help$' eval ab $S/red $S/green -o a.html --names one
  fails 2 '^pixelsynth weights info: .*see pixelsynth weights info --help$' weights info
  fails 2 '^pixelsynth probe splat: .*see pixelsynth probe splat --help$' probe splat
  fails 2 '^pixelsynth eval: .*see pixelsynth eval --help$' eval
  fails 2 '^pixelsynth: .*see pixelsynth --help$' --nonsense]=])
app_test(outputs_without_a_name_are_wrong_usage [=[
  fails 2 'output: the folder.s name is empty; expected a folder' chart -o '' --knobs radius
  fails 2 'output: the folder.s name is empty' stress -o ''
  fails 2 'output: the name is empty; expected a name ending in .json' eval depth $S/walk -o ''
  fails 2 'output: .*expected a name ending in .ply or .pcd' fuse $S/walk -o '']=])
app_test(missing_output_is_wrong_usage "fails 2 'output is required' fuse $S/walk")
app_test(missing_cloud_is_wrong_usage "fails 2 'cloud is required' render -o a.png")
app_test(values_out_of_range_are_wrong_usage [=[
  fails 2 'radius' render $S/mixed.ply -o a.png --radius 0
  fails 2 'radius' render $S/mixed.ply -o a.png --radius nan
  fails 2 'depth-scale' fuse $S/walk -o a.ply --depth-scale 0
  fails 2 'fps' render $S/mixed.ply -o a.mp4 --fps 0.5
  fails 2 'every' fuse $S/walk -o a.ply --every 0
  fails 2 'fov' scene $S/photo.png --depth $S/depth.png --no-outpaint -o a --fov 180
  fails 2 'threads' --threads -1 fuse $S/walk -o a.ply]=])
app_test(whole_numbers_are_whole_and_in_range [=[
  for n in -1 1.5 1e3 x 18446744073709551616; do
    fails 2 "seed: '$n'.* expected a whole number" --seed $n fuse $S/walk -o a.ply
  done
  fails 2 "every: '1.5'.* whole number from 1" fuse $S/walk -o a.ply --every 1.5
  works --seed 18446744073709551615 fuse $S/walk -o a.ply --every 3
  grep -q '"seed": 18446744073709551615' a.settings.json]=])
app_test(options_that_leave_nothing_are_named_with_what_would_be_right [=[
  fails 2 'hold-out: 1 leaves no frame.* 2 and more' fuse $S/walk -o a.ply --hold-out 1
  fails 2 'min-depth: 5 is more than --max-depth 2' fuse $S/walk -o a.ply --min-depth 5 --max-depth 2
  fails 2 'min-depth: 5 is more than --max-depth 2' scene $S/photo.png --depth $S/depth.png --no-outpaint -o a --min-depth 5 --max-depth 2
  fails 1 'frames: no frame is in 100:.* within 0:6' fuse $S/walk -o a.ply --frames 100:
  fails 1 'no pixel can be lifted.* range' fuse $S/walk -o a.ply --min-depth 50]=])
app_test(names_given_twice_are_wrong_usage [=[
  twice="is given twice; expected each once"
  fails 2 "knobs: radius $twice" chart -o c --knobs radius,budget,radius
  fails 2 "methods: copy $twice" eval views $S/walk --methods copy,copy
  fails 2 "methods: support $twice" eval consistency $S/walk --methods support,support
  fails 2 "axes: splat-narrow $twice" stress -o s --axes splat-narrow --axes splat-narrow
  fails 2 "directions: left $twice" scene $S/photo.png -o s --directions left,up,left]=])
app_test(odd_sizes_and_ranges_are_wrong_usage [=[
  for s in 640 0x10 10x0 axb 10x-5 99999x10 x; do fails 2 'size' render $S/mixed.ply -o a.png --size $s; done
  for f in a:b 5:3 1:2:3 nan:; do fails 2 'frames' fuse $S/walk -o a.ply --frames $f; done
  fails 2 'background' render $S/mixed.ply -o a.png --background 1,2
  fails 2 'background' render $S/mixed.ply -o a.png --background 1,2,256]=])
app_test(fov_and_intrinsics_exclude_each_other "fails 2 'fov' render $S/mixed.ply -o a.png --fov 60 --intrinsics $S/lens.json")
app_test(a_video_holds_no_depth "fails 2 'depth' render $S/mixed.ply -o a.mp4 --depth")
app_test(common_options_stand_before_or_after_the_verb [=[
  works -q --threads 1 fuse $S/walk -o a.ply --every 3
  works fuse $S/walk -o b.ply --every 3 --threads 1 -q
  cmp a.ply b.ply]=])
app_test(quiet_says_nothing [=[
  works -q fuse $S/walk -o a.ply --every 3
  is ! -s "$work/err"
  is ! -s "$work/out"]=])
app_test(quiet_keeps_results_on_stdout [=[
  works --help
  prints 'Say nothing but errors on stderr; results on stdout stay'
  works -q eval cloud $S/mixed.ply $S/seen.pcd
  is ! -s "$work/err"
  prints '^mixed.ply '
  works -q weights info $S/depth.safetensors
  is ! -s "$work/err"
  prints '^all ']=])
app_test(without_a_terminal_there_is_no_bar [=[
  works fuse $S/walk -o a.ply --every 3
  is "$(wc -l <"$work/err")" -eq 1]=])
app_test(json_on_stdout_is_the_report [=[
  works -q --json fuse $S/walk -o a.ply
  cmp "$work/out" a.report.json]=])
app_test(a_report_that_cannot_be_printed_is_a_failure [=[
  got=0
  $program -q --json fuse $S/walk -o a.ply >/dev/full 2>"$work/err" || got=$?
  is $got -eq 1
  is "$(wc -l <"$work/err")" -eq 1
  says 'json.*stdout']=])
app_test(words_that_cannot_be_printed_are_a_failure [=[
  for args in --help --version "" "fuse --help" "weights info $S/depth.safetensors" "eval cloud $S/mixed.ply $S/mixed.ply"; do
    got=0
    $program $args >/dev/full 2>"$work/err" || got=$?
    is $got -eq 1
    is "$(wc -l <"$work/err")" -eq 1
    says '^pixelsynth: stdout: cannot be written: No space left on device'
  done
  got=0
  $program --help >&- 2>"$work/err" || got=$?
  is $got -eq 1
  says '^pixelsynth: stdout: cannot be written: ']=])
app_test(options_given_twice_are_wrong_usage [=[
  fails 2 'every can be given once; see pixelsynth fuse' fuse $S/walk -o a.ply --every 2 --every 3
  fails 2 'output can be given once; see pixelsynth render' render $S/mixed.ply -o a.png -o b.png
  fails 2 'seed can be given once' --seed 1 --seed 2 fuse $S/walk -o a.ply]=])
app_test(missing_files_are_named [=[
  fails 1 'absent' fuse absent -o a.ply
  fails 1 'absent.ply' render absent.ply -o a.png
  fails 1 'absent.ply' view absent.ply --screenshot a.png
  fails 1 'absent.png' scene absent.png --depth $S/depth.png --no-outpaint -o a
  fails 1 'absent.png' scene $S/photo.png --depth absent.png --no-outpaint -o a
  fails 1 'absent.safetensors' probe splat --in absent.safetensors --out a.safetensors]=])
app_test(outputs_that_cannot_be_are_refused_before_the_work [=[
  fails 1 'no_folder' fuse $S/walk -o no_folder/a.ply
  fails 2 'ply or .pcd' fuse $S/walk -o a.obj
  fails 1 'no_folder' render $S/mixed.ply -o no_folder/a.mp4
  fails 2 'mp4 or .png' render $S/mixed.ply -o a.avi
  fails 1 'no_folder' scene $S/photo.png --depth $S/depth.png --no-outpaint -o no_folder/a
  mkdir b.report.json
  fails 1 'b.report.json: is a folder' fuse $S/walk -o b.ply
  mkdir -p s/preview.png
  touch s/views file
  mkdir c.depth.png
  fails 1 'c.depth.png: is a folder' render $S/mixed.ply -o c.png --depth
  fails 1 's/.* is a f' -q scene $S/photo.png --depth $S/depth.png --no-outpaint -o s
  fails 1 'is a file' scene $S/photo.png --depth $S/depth.png --no-outpaint -o file]=])
# Neither photo nor weights are there: what is said of the output is said before they are looked at.
app_test(output_folders_that_cannot_take_a_scene_are_refused_before_the_work [=[
  args="scene $S/photo.png --depth $S/depth.png --weights $S/photo.png -o"
  ln -s nowhere link
  fails 1 '^pixelsynth: link: is a link to nowhere, which is not there; expected' $args link
  fails 1 '^pixelsynth: link: is a link to nowhere' render $S/mixed.ply -o link/
  for root in / /.. //; do
    fails 1 'is the root of all folders; expected a folder in it' $args $root
  done
  mkdir -p a/scene.ply b/views/left.png c d/sway.mp4
  touch c/views
  fails 1 '^pixelsynth: a/scene.ply: is a folder; expected a file' $args a
  fails 1 '^pixelsynth: b/views/left.png: is a folder; expected a file' $args b
  fails 1 '^pixelsynth: c/views: is a file; expected a folder' $args c
  fails 1 '^pixelsynth: d/sway.mp4: is a folder; expected a file' $args d --paths sway]=])
app_test(bad_photos_fail_with_one_line [=[
  for f in nothing.jpg truncated.jpg truncated.png text.png damaged.png damaged.bmp damaged.ppm damaged.pgm damaged.tiff damaged.webp; do
    fails 1 $f scene $S/$f --depth $S/depth.png --no-outpaint -o a
  done]=])
app_test(decoders_print_nothing_of_their_own [=[
  works scene $S/damaged.jpg --depth $S/depth.png --fov 60 --no-outpaint -o s
  is "$(wc -l <"$work/err")" -eq 1
  says '^s: .* points']=])
app_test(bad_clouds_fail_with_one_line [=[
  for f in empty.ply promise.ply photo.png; do
    fails 1 $f render $S/$f -o a.png
    fails 1 $f view $S/$f --screenshot a.png
  done]=])
app_test(bad_trajectories_fail_with_one_line [=[
  for f in nan.txt zero_quaternion.txt mirror.log photo.png; do
    fails 1 $f render $S/mixed.ply -o a.png --trajectory $S/$f
    fails 1 $f render $S/mixed.ply -o a --start $S/$f
  done]=])
app_test(a_timestamp_that_comes_twice_fails_with_file_and_line [=[
  fails 1 'twice.txt:3: timestamp 1 ' render $S/mixed.ply -o a.png --trajectory $S/twice.txt
  cp -r $S/walk w
  cp $S/twice.txt w/trajectory.txt
  fails 1 'w/trajectory.txt:3: timestamp 1 ' fuse w -o a.ply]=])
app_test(points_that_are_not_finite_are_counted_in_a_warning [=[
  works render $S/nan.ply -o a.png
  says 'warning.*nan.ply: 2 points are not finite'
  fails 1 'nans.ply: all its 2 points are not finite' -q render $S/nans.ply -o b.png]=])
app_test(bad_tensors_fail_with_one_line [=[
  fails 1 broken probe splat --in $S/broken.safetensors --out a.safetensors
  fails 1 'shapes' probe splat --in $S/misfit.safetensors --out a.safetensors
  fails 1 "no tensor 'x.points'" probe splat --in $S/two.safetensors --prefix x. --out a.safetensors]=])
app_test(a_folder_without_depth_fails_with_one_line "fails 1 no_depth fuse $S/no_depth -o a.ply")
app_test(failures_name_the_output_and_no_unfinished_file [=[
  mkdir -p m/frame_00001.png
  fails 1 ' m/frame_00001.png: is a folder' -q render $S/mixed.ply -o m
  ulimit -f 1
  trap '' XFSZ
  fails 1 ' r/frame_00000.png: writing failed' -q render $S/mixed.ply -o r
  fails 1 ' r.mp4: writing failed: File too large' -q render $S/mixed.ply -o r.mp4 --size 320x240 --frames 40
  fails 1 ' s/scene.ply: writing failed' -q scene $S/photo.png --depth $S/depth.png --no-outpaint -o s]=])
app_test(a_full_disk_leaves_all_outputs_or_none [=[
  works fuse $S/walk -o a.ply --every 3 --hold-out 2
  works depth $S/photo.png -o d.pfm --weights $S/depth.safetensors
  cp -r . ../before
  trap '' XFSZ
  ulimit -f 20
  fails 1 ' a.ply: writing failed' -q fuse $S/walk -o a.ply
  fails 1 ' b.ply: writing failed' -q fuse $S/walk -o b.ply
  fails 1 ' d.pfm: writing failed' -q depth $S/noise.png -o d.pfm --weights $S/depth.safetensors
  fails 1 ' e.pfm: writing failed' -q depth $S/noise.png -o e.pfm --weights $S/depth.safetensors
  diff -r . ../before]=])
# A process of number 4194305 there never is.
app_test(what_a_killed_run_left_is_removed_by_the_next [=[
  "$program" -q render $S/mixed.ply -o a --size 1024x768 --frames 5000 & pid=$!
  for i in $(seq 300); do
    [ ! -e a.partial-$pid/frame_00001.png ] || break
    sleep 0.1
  done
  kill -KILL $pid
  wait $pid || true
  is -e a.partial-$pid/frame_00001.png
  mkdir a.partial-$$ a.partial-x a.partial-04194305 a.partial-4194305x b.partial-4194305 a.partial-4194306
  ln -s b.partial-4194305 a.partial-4194307
  touch a.partial-4194308 b.partial-4194305/file
  pixelsynth -q render $S/mixed.ply -o a --frames 2
  is ! -e a.partial-$pid
  is ! -e a.partial-4194306
  is "$(ls | grep -c partial)" -eq 7
  writes a/frame_00001.png
  is -e b.partial-4194305/file]=])
app_test(files_that_a_killed_run_left_are_removed_by_the_next [=[
  touch .ps-4194305-17.ply .ps-4194306-17.json .ps-$$-17.ply .ps-17.ply .ps-4194305x-17.ply
  pixelsynth -q fuse $S/walk -o a.ply --every 3
  writes a.ply
  is "$(ls -A | grep '^[.]ps-' | LC_ALL=C sort | xargs)" = "$(printf '%s\n' .ps-$$-17.ply .ps-17.ply .ps-4194305x-17.ply | LC_ALL=C sort | xargs)"]=])
app_test(what_another_run_holds_is_not_removed [=[
  needs flock
  mkdir a.partial-4194305
  flock --no-fork a.partial-4194305 sleep 30 & holder=$!
  for i in $(seq 100); do
    flock -n a.partial-4194305 true || break
    sleep 0.1
  done
  pixelsynth -q render $S/mixed.ply -o a --frames 2
  is -d a.partial-4194305
  kill $holder]=])
# env: a script's jobs in the background begin with SIGINT ignored.
app_test(an_interrupt_leaves_nothing [=[
  for signal in INT TERM; do
    env --default-signal=INT "$program" render $S/mixed.ply -o a --size 1024x768 --frames 5000 2>"$work/err" & pid=$!
    sleep 1.5
    find . | grep -q partial || complain "nothing was begun"
    kill -$signal $pid
    wait $pid && complain "an interrupted run succeeded"
    [ "$(grep -c interrupted "$work/err")" -eq 1 ] || complain "it does not say so"
    [ "$(find .)" = . ] || complain "left: $(find . | head)"
  done]=])
app_test(a_signal_that_was_ignored_stays_ignored [=[
  for signal in INT HUP; do
    trap '' $signal
    "$program" render $S/mixed.ply -o a --size 512x384 --frames 40 2>"$work/err" & pid=$!
    for i in $(seq 100); do
      kill -$signal $pid 2>/dev/null || break
      sleep 0.05
    done
    wait $pid || complain "it ended by $signal"
    writes a/frame_00039.png
    rm -r a
  done]=])
