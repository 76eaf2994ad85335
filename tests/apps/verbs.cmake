# SPDX-License-Identifier: BSD-3-Clause
# What each verb does with sound input.
app_test(fuse_writes_cloud_report_settings_poses_and_lens [=[
  works fuse $S/walk -o a.ply
  writes a.ply a.report.json a.settings.json a.trajectory.txt a.intrinsics.json
  head -c 3 a.ply | grep -q ply
  is "$(json views a.report.json)" -eq 7
  is "$(json points a.report.json)" -gt 5000
  says 'a.ply: [0-9]+ points from 7 views']=])
app_test(fuse_studies_frames_first_if_asked [=[
  works fuse $S/walk -o a.ply --study
  writes a.ply a.report.json
  is "$(json refused a.report.json)" -eq 0
  grep -q '"gave_up": false' a.report.json
  grep -q '"tolerance_relative": 0\.' a.report.json
  is "$(grep -c '"gain"' a.report.json)" -eq 7
  works --threads 1 fuse $S/walk -o b.ply --study
  cmp a.ply b.ply]=])
app_test(fuse_names_frames_that_its_study_refuses [=[
  cp -r $S/walk w
  awk '$1 == 3 { $4 -= 1 } 1' $S/walk/trajectory.txt > w/trajectory.txt
  works fuse w -o a.ply --study
  says 'warning: 1 frame is left out, .* its pose '
  is "$(json refused a.report.json)" -eq 1
  is "$(json without_depth a.report.json)" -eq 0
  is "$(json views a.report.json)" -eq 6
  grep -A1 '"refused": \[' a.report.json | grep -q 'w/color/00003.png"']=])
app_test(fuse_writes_pcd [=[
  works fuse $S/walk -o a.pcd
  writes a.pcd
  head -n 1 a.pcd | grep -q PCD
  works fuse $S/walk -o b.pcd --compress
  grep -aqx 'DATA binary_compressed' b.pcd
  works --json render b.pcd -o r.png
  is "$(json points "$work/out")" -eq "$(json points b.report.json)"
  is "$(json points b.report.json)" -eq "$(json points a.report.json)"
  fails 2 'compress.*pcd' fuse $S/walk -o c.ply --compress]=])
app_test(fuse_keeps_the_report_of_a_cloud_of_the_same_name_and_another_kind [=[
  works fuse $S/walk -o a.ply
  fails 1 'a.report.json: is the report of a.ply and would be replaced; expected another name than a.pcd' fuse $S/walk -o a.pcd
  cp a.ply a.pcd
  works fuse $S/walk -o a.ply
  rm a.ply
  works fuse $S/walk -o a.pcd]=])
app_test(fuse_scales_depth_of_another_size_with_one_warning [=[
  cp -r $S/walk w
  for f in w/depth/*; do cp $S/half.png $f; done
  works fuse w -o a.ply
  is "$(grep -c warning "$work/err")" -eq 1
  says 'warning: 7 depth images.*scaled']=])
app_test(fuse_does_not_depend_on_threads [=[
  works --threads 1 fuse $S/walk -o a.ply
  works --threads 3 fuse $S/walk -o b.ply
  cmp a.ply b.ply]=])
app_test(fuse_does_not_depend_on_the_order_of_folders [=[
  works fuse $S/part_a $S/part_b -o a.ply
  works fuse $S/part_b $S/part_a -o b.ply
  works fuse $S/walk -o c.ply
  cmp a.ply b.ply
  cmp a.ply c.ply]=])
app_test(fuse_does_not_depend_on_the_order_of_poses_in_a_trajectory [=[
  cp -r $S/walk w
  sort -r $S/walk/trajectory.txt > w/trajectory.txt
  works fuse $S/walk -o a.ply
  works fuse w -o b.ply
  cmp a.ply b.ply
  cmp a.trajectory.txt b.trajectory.txt]=])
app_test(fuse_numbers_the_frames_of_folders_with_the_same_timestamps [=[
  works fuse $S/part_a $S/part_a/../part_a -o a.ply
  grep -v '#' a.trajectory.txt | cut -d' ' -f1 | xargs | grep -qx '0 1 2 3 4 5 6 7'
  works render a.ply -o r.png]=])
app_test(fuse_leaves_out_frames_without_depth_with_one_warning [=[
  cp -r $S/walk w
  for i in 1 2 4; do cp $S/zero.png w/depth/0000$i.png; done
  works fuse w -o a.ply
  is "$(grep -c warning "$work/err")" -eq 1
  says 'warning: 3 frames have no depth'
  is "$(json views a.report.json)" -eq 4
  is "$(json without_depth a.report.json)" -eq 3
  rm a.*
  for f in w/depth/*; do cp $S/zero.png $f; done
  fails 1 'w: no frame has any depth' fuse w -o b.ply]=])
app_test(fuse_render_and_scene_end_in_the_same_kind_of_line [=[
  works --json fuse $S/walk -o a.ply
  says '^a.ply: .* in [0-9.]+ s$'
  is -n "$(json peak_memory_mib "$work/out")"
  works --json render a.ply -o r.png
  says '^r.png: .* in [0-9.]+ s$'
  is -n "$(json peak_memory_mib "$work/out")"
  works --json scene $S/photo.png --depth $S/depth.png --no-outpaint -o s
  says '^s: .* in [0-9.]+ s$'
  is -n "$(json peak_memory_mib "$work/out")"]=])
app_test(fuse_frames_are_inclusive_and_every_counts_within_them [=[
  works fuse $S/walk -o a.ply --frames 2:5
  is "$(json views a.report.json)" -eq 4
  works fuse $S/walk -o a.ply --frames 2:5 --every 2
  grep -v '#' a.trajectory.txt | cut -d' ' -f1 | xargs | grep -qx '2 4'
  works fuse $S/walk -o a.ply --frames 5:
  is "$(json views a.report.json)" -eq 2
  works fuse $S/walk -o a.ply --frames :0
  is "$(json views a.report.json)" -eq 1
  rm a.*
  fails 1 frames fuse $S/walk -o b.ply --frames 100:]=])
app_test(fuse_holds_frames_out [=[
  works fuse $S/walk -o a.ply --hold-out 3
  grep -v '#' a.held-out.txt | cut -d' ' -f1 | xargs | grep -qx '1 4'
  is "$(json views a.report.json)" -eq 5
  is "$(json held_out a.report.json)" -eq 2
  works fuse $S/walk -o a.ply
  is ! -e a.held-out.txt]=])
app_test(fuse_with_a_wider_spacing_keeps_fewer_points [=[
  works fuse $S/walk -o a.ply
  works fuse $S/walk -o b.ply --spacing 0.1
  is "$(json points b.report.json)" -lt $(($(json points a.report.json) / 2))]=])
app_test(settings_hold_every_option_and_the_seed [=[
  works --seed 7 fuse $S/walk -o a.ply --every 2
  for key in '"seed": 7' '"version"' '"every": 2' '"edge-footprints"' '"depth-scale": 1000'; do
    grep -q "$key" a.settings.json || complain "$key is missing"
  done]=])
app_test(render_shows_points_as_wide_as_they_stand_for [=[
  works fuse $S/walk -o a.ply --spacing 0.05
  works render a.ply -o fine.png
  works render a.ply -o wide.png --finest 4
  works render a.ply -o wider.png --finest 64
  cmp wide.png wider.png || complain 'splats wider than --radius'
  if cmp -s fine.png wide.png; then complain '--finest does nothing'; fi]=])
app_test(render_writes_frames_poses_and_lens_into_a_folder [=[
  works fuse $S/walk -o a.ply
  works render a.ply -o r --trajectory sway --frames 5 --depth
  writes r/frame_0000{0,1,2,3,4}.png r/depth_0000{0,4}.png r/trajectory.txt r/intrinsics.json
  is "$(ls r | wc -l)" -eq 12
  is "$(grep -vc '#' r/trajectory.txt)" -eq 5
  is "$(size_of r/frame_00000.png)" = 96x64]=])
app_test(render_again_replaces_its_frames_and_keeps_other_files [=[
  works render $S/mixed.ply -o r --frames 5 --size 64x48
  echo mine > r/notes.txt
  works render $S/mixed.ply -o r --frames 2 --size 32x24
  is "$(ls r | xargs)" = "frame_00000.png frame_00001.png intrinsics.json notes.txt trajectory.txt"
  is "$(size_of r/frame_00000.png)" = 32x24]=])
app_test(render_follows_every_kind_of_path [=[
  for p in circle sway left right up down up-left up-right down-left down-right $S/walk/trajectory.txt; do
    works render $S/mixed.ply -o r.png --trajectory $p --size 40x30
  done
  fails 1 'spiral.*up-left' render $S/mixed.ply -o r --trajectory spiral]=])
app_test(render_sways_to_both_sides_in_three_frames [=[
  works render $S/mixed.ply -o r --trajectory sway --size 40x30 --frames 3
  is "$(md5sum r/frame* | cut -d' ' -f1 | sort -u | wc -l)" -eq 3]=])
app_test(render_takes_all_poses_of_a_file_or_some [=[
  works render $S/mixed.ply -o r --trajectory $S/walk/trajectory.txt --size 40x30
  is "$(ls r/frame* | wc -l)" -eq 7
  works render $S/mixed.ply -o r --trajectory $S/walk/trajectory.txt --size 40x30 --frames 3
  is "$(ls r/frame* | wc -l)" -eq 3]=])
app_test(render_at_the_photo_s_pose_gives_the_photo_back [=[
  needs ffmpeg
  works scene $S/photo.png --depth $S/depth.png --intrinsics $S/lens.json --no-outpaint -o s
  works render s/scene.ply -o r.png --radius 0.9
  for xy in '20 20' '48 32' '70 10' '80 55'; do is "$(pixel r.png $xy)" = "$(pixel $S/photo.png $xy)"; done]=])
app_test(render_left_looks_left [=[
  needs ffmpeg
  works scene $S/photo.png --depth $S/depth.png --intrinsics $S/lens.json --no-outpaint -o s
  works render s/scene.ply -o r --trajectory left --frames 2 --background 255,0,255
  is "$(pixel r/frame_00001.png 2 32)" = "255 0 255"
  is "$(pixel r/frame_00001.png 94 32)" != "255 0 255"
  works render s/scene.ply -o r --trajectory up --frames 2 --background 255,0,255
  is "$(pixel r/frame_00001.png 48 2)" = "255 0 255"
  is "$(pixel r/frame_00001.png 48 62)" != "255 0 255"]=])
app_test(render_leaves_no_dark_holes_between_points [=[
  needs ffmpeg
  works scene $S/photo.png --depth $S/depth.png --intrinsics $S/lens.json --no-outpaint -o s
  works render s/scene.ply -o r.png --trajectory s/trajectory.txt --size 384x256
  is "$(pixel r.png 192 40 | cut -d' ' -f3)" -gt 190]=])
app_test(render_writes_h264_that_browsers_play [=[
  needs ffprobe
  works render $S/mixed.ply -o r.mp4 --frames 8 --size 75x51 --fps 10
  ffprobe -v error -show_entries stream=codec_name,pix_fmt,width,height,nb_frames -of csv=p=0 r.mp4 > probe.txt
  grep -qx 'h264,76,52,yuv420p,8' probe.txt || complain "$(cat probe.txt)"]=])
app_test(a_part_that_is_not_beside_the_program_is_named [=[
  cp "$program" alone
  program=./alone
  fails 1 'video: libpixelsynth_video.so is missing.*here/libpixelsynth_video.so or ' -q render $S/mixed.ply -o r.mp4
  works render $S/mixed.ply -o r.png]=])
app_test(render_picks_points_by_origin [=[
  works --json render $S/mixed.ply -o r.png
  all=$(json points "$work/out")
  works --json render $S/mixed.ply -o r.png --origin observed
  seen=$(json points "$work/out")
  works --json render $S/mixed.ply -o r.png --origin outpainted
  made=$(json points "$work/out")
  is $((seen + made)) -eq $all
  is $seen -gt 0
  is $made -gt 0
  rm r.png
  fails 1 outpainted render $S/seen.pcd -o r.png --origin outpainted]=])
app_test(render_keeps_the_lens_and_never_squashes [=[
  works --json render $S/mixed.ply -o r.png --intrinsics $S/lens.json --size 100x100
  is "$(size_of r.png)" = 100x100
  fx=$(sed -n 's/.*"fx": \([^,]*\).*/\1/p' "$work/out") fy=$(sed -n 's/.*"fy": \([^,]*\).*/\1/p' "$work/out")
  is -n "$fx"
  is "$fx" = "$fy"]=])
app_test(render_without_poses_starts_outside_and_says_so [=[
  works render $S/seen.pcd -o r.png
  says 'start: outside'
  says 'lens: 60']=])
app_test(render_takes_clouds_without_colour [=[
  works render $S/no_color.ply -o r.png
  writes r.png]=])
app_test(scene_writes_all_its_files [=[
  works scene $S/photo.jpg --depth $S/depth.png --fov 70 --no-outpaint -o s
  writes s/scene.ply s/preview.png s/trajectory.txt s/intrinsics.json s/report.json s/settings.json s/views/input.png
  for d in left right up down up-left up-right down-left down-right; do writes s/views/$d.png; done
  for d in left right up down up-left up-right down-left down-right; do writes s/views/${d}_1.png; done
  is "$(grep -vc '#' s/trajectory.txt)" -eq 17
  is "$(json outpainted s/report.json)" -eq 0
  says 's: [0-9]+ points']=])
app_test(scene_again_leaves_no_views_of_an_earlier_scene [=[
  args="scene $S/photo.png --depth $S/depth.png --no-outpaint"
  works $args -o s --directions left,up --paths sway --path-frames 2
  echo mine > s/views/mine.png
  echo mine > s/circle.mp4
  works $args -o s --directions right
  is "$(LC_ALL=C ls s/views | xargs)" = "input.png mine.png right.png right_1.png"
  is ! -e s/sway.mp4
  is -e s/circle.mp4
  is "$(grep -vc '#' s/trajectory.txt)" -eq 3]=])
app_test(scene_scales_depth_of_another_size_with_a_warning [=[
  works scene $S/photo.png --depth $S/half.png --fov 70 --no-outpaint -o s
  says 'warning.*48x32.*96x64']=])
app_test(scene_refuses_depth_of_another_shape "fails 1 'square.png.*aspect' scene $S/photo.png --depth $S/square.png --no-outpaint -o s")
app_test(scene_refuses_depth_of_a_pixel "fails 1 'tiny.png: is 1x1.*aspect' scene $S/photo.png --depth $S/tiny.png --no-outpaint -o s")
app_test(scene_refuses_a_lens_of_another_shape "fails 1 'square_lens.*aspect' scene $S/photo.png --depth $S/depth.png --no-outpaint -o s --intrinsics $S/square_lens.json")
app_test(scene_refuses_depth_without_a_value "fails 1 zero.png scene $S/photo.png --depth $S/zero.png --no-outpaint -o s")
app_test(scene_refuses_a_photo_as_depth "fails 1 photo.png scene $S/photo.png --depth $S/photo.png --no-outpaint -o s")
app_test(scene_refuses_a_depth_range_without_pixels "fails 1 'range' scene $S/photo.png --depth $S/depth.png --no-outpaint -o s --min-depth 50")
app_test(scene_says_which_lens_it_takes [=[
  works scene $S/photo.png --depth $S/depth.png --no-outpaint -o s
  says 'lens: 60 degrees']=])
app_test(view_takes_a_picture_without_a_screen [=[
  needs Xvfb
  works view $S/mixed.ply --screenshot v.png --size 200x150
  is "$(size_of v.png)" = 200x150]=])
app_test(view_shows_the_photo_the_right_way_up [=[
  needs Xvfb
  needs ffmpeg
  works scene $S/photo.png --depth $S/depth.png --intrinsics $S/lens.json --no-outpaint -o s
  works view s/scene.ply --screenshot v.png --size 192x128 --no-axes --no-cameras
  read -r r g b <<<"$(pixel v.png 96 64)"
  is $r -gt 200
  read -r r g b <<<"$(pixel v.png 20 20)"
  is $r -gt 150
  is $b -gt 190
  read -r r g b <<<"$(pixel v.png 170 20)"
  is $r -lt 50
  is $b -gt 190
  read -r r g b <<<"$(pixel v.png 150 110)"
  is $g -gt 190]=])
app_test(view_colours_by_each_property [=[
  needs Xvfb
  for c in photo depth view origin; do works view $S/mixed.ply --screenshot $c.png --color-by $c --size 120x90; done
  for c in depth view origin; do ! cmp -s photo.png $c.png || complain "$c looks like photo"; done]=])
app_test(view_without_a_screen_says_what_to_do "fails 1 'DISPLAY.*--screenshot' -q view $S/mixed.ply")
app_test(view_without_xvfb_says_what_to_install [=[
  program="env PATH=/nowhere $program"
  fails 1 'xvfb' -q view $S/mixed.ply --screenshot v.png]=])
app_test(probe_splat_writes_all_tensors [=[
  works probe splat --in $S/two.safetensors --out o.safetensors --size 16
  for t in image count idx4 bg_raw bg_dilated; do head -c 600 o.safetensors | grep -aq "\"$t\"" || complain "$t is missing"; done]=])
app_test(probe_splat_warns_of_points_that_are_not_finite [=[
  for prefix in "" nan.; do
    works probe splat --in $S/nan.safetensors --prefix "$prefix" --out o.safetensors --size 16
    says 'warning.*nan.safetensors: 1 points are not finite'
  done]=])
