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
