# SPDX-License-Identifier: BSD-3-Clause
app_test(scene_joins_two_photos_by_a_given_pose [=[
  echo '0 0.1 0 0 0 0 0 1' > pose.txt
  works scene $S/photo.png --depth $S/depth.png --fov 70 --no-outpaint -o one
  works scene $S/photo.png --depth $S/depth.png --second $S/photo.png --second-depth $S/depth.png --second-pose pose.txt --fov 70 --no-outpaint -o s
  is "$(json points s/report.json)" -gt "$(json points one/report.json)"
  works scene $S/photo.png --fov 70 --second $S/photo.png --second-pose pose.txt -o t --samples 1 --directions left
  grep -q '"depth_scale"' t/report.json
  works scene $S/photo.png --depth $S/depth.png --second $S/photo.png --second-depth $S/depth.png --second-pose pose.txt --no-outpaint -o v
  is "$(grep -c 'lens: 60 degrees' "$work/err")" -eq 1
  fails 1 'absent.txt' -q scene $S/photo.png --depth $S/depth.png --second $S/photo.png --second-pose absent.txt -o u]=])
app_test(scene_refuses_a_second_photo_that_has_nothing_in_common [=[
  fails 1 'second photo: .*second-pose FILE' -q scene $S/photo.png --depth $S/depth.png --second $S/noise.png --fov 70 --no-outpaint -o s]=])
app_test(scene_warns_of_a_poor_pose_of_the_second_photo [=[
  needs_shared rgbd/walk/color/00300.jpg
  works scene $shared/rgbd/walk/color/00300.jpg --second $shared/rgbd/walk/color/00305.jpg --no-outpaint -o s
  says '^warning: --second: its pose is poor: half of its matches miss by more than 1[0-9] pixels'
  works scene $shared/rgbd/walk/color/00300.jpg --second $shared/rgbd/walk/color/00300.jpg --no-outpaint -o t
  ! grep -q 'pose is poor' "$work/err" || complain "the same photo's pose is called poor"]=])
