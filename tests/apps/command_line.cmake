# SPDX-License-Identifier: BSD-3-Clause
# What holds for all verbs: exit status, one line for one failure, nothing half-written.
app_test(no_verb_prints_help [=[
  works
  prints 'Subcommands'
  prints 'fuse']=])
app_test(every_verb_has_help [=[for v in scene fuse render view "probe splat"; do works $v --help; prints Options; done]=])
app_test(version_is_printed [=[
  works --version
  prints '^pixelsynth [0-9]+[.][0-9]+[.][0-9]+$']=])
app_test(unknown_verb_is_wrong_usage "fails 2 'frobnicate' frobnicate")
app_test(unknown_option_is_wrong_usage "fails 2 'nonsense.*see pixelsynth fuse --help' fuse $S/walk -o a.ply --nonsense")
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
app_test(missing_files_are_named [=[
  fails 1 'absent' fuse absent -o a.ply
  fails 1 'absent.ply' render absent.ply -o a.png
  fails 1 'absent.ply' view absent.ply --screenshot a.png
  fails 1 'absent.png' scene absent.png --depth $S/depth.png --no-outpaint -o a
  fails 1 'absent.png' scene $S/photo.png --depth absent.png --no-outpaint -o a
  fails 1 'absent.safetensors' probe splat --in absent.safetensors --out a.safetensors]=])
app_test(outputs_that_cannot_be_are_refused_before_the_work [=[
  fails 1 'no_folder' fuse $S/walk -o no_folder/a.ply
  fails 1 'ply or .pcd' fuse $S/walk -o a.obj
  fails 1 'no_folder' render $S/mixed.ply -o no_folder/a.mp4
  fails 1 'mp4 or .png' render $S/mixed.ply -o a.avi
  fails 1 'no_folder' scene $S/photo.png --depth $S/depth.png --no-outpaint -o no_folder/a
  mkdir b.report.json
  fails 1 'b.report.json: is a folder' fuse $S/walk -o b.ply
  mkdir -p s/preview.png
  touch s/views file
  fails 1 's/.* is a f' -q scene $S/photo.png --depth $S/depth.png --no-outpaint -o s
  fails 1 'is a file' scene $S/photo.png --depth $S/depth.png --no-outpaint -o file]=])
app_test(bad_photos_fail_with_one_line [=[
  for f in nothing.jpg truncated.jpg truncated.png text.png; do
    fails 1 $f scene $S/$f --depth $S/depth.png --no-outpaint -o a
  done]=])
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
app_test(bad_tensors_fail_with_one_line [=[
  fails 1 broken probe splat --in $S/broken.safetensors --out a.safetensors
  fails 1 'shapes' probe splat --in $S/misfit.safetensors --out a.safetensors
  fails 1 "no tensor 'x.points'" probe splat --in $S/two.safetensors --prefix x. --out a.safetensors]=])
app_test(a_folder_without_depth_fails_with_one_line "fails 1 no_depth fuse $S/no_depth -o a.ply")
app_test(an_interrupt_leaves_nothing [=[
  for signal in INT TERM; do
    "$program" render $S/mixed.ply -o a --size 1024x768 --frames 5000 2>"$work/err" & pid=$!
    sleep 1.5
    find . | grep -q partial || complain "nothing was begun"
    kill -$signal $pid
    wait $pid && complain "an interrupted run succeeded"
    [ "$(grep -c interrupted "$work/err")" -eq 1 ] || complain "it does not say so"
    [ "$(find .)" = . ] || complain "left: $(find . | head)"
  done]=])
