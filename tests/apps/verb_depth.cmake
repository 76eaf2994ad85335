# SPDX-License-Identifier: BSD-3-Clause
# depth, and scene where it estimates depth. The weights are by chance: what they say is of no matter here.
app_test(depth_writes_depth_preview_and_report [=[
  works depth $S/photo.png -o d.png --weights $S/depth.safetensors --fov 70
  writes d.png d.preview.png d.report.json
  is "$(ls | wc -l)" -eq 3
  is "$(json clipped d.report.json)" -eq 0
  says 'd.png: depth of 96x64 pixels.* not promised.* in [0-9.]+ s$'
  grep -q '"metric_depth_promised": false' d.report.json
  works scene $S/photo.png --depth d.png --fov 70 --no-outpaint -o s]=])
app_test(depth_and_preview_have_the_photo_s_size [=[
  needs ffmpeg
  works depth $S/photo.jpg -o d.png --weights $S/depth.safetensors
  is "$(size_of d.png)" = 96x64
  is "$(size_of d.preview.png)" = 96x64]=])
app_test(depth_says_where_the_focal_length_comes_from [=[
  works depth $S/photo.png -o d.png --weights $S/depth.safetensors
  says 'lens: 60 degrees'
  grep -q '"from": "default"' d.report.json
  works depth $S/photo.png -o d.png --weights $S/depth.safetensors --fov 70
  grep -q '"from": "--fov"' d.report.json
  works depth $S/photo.png -o d.png --weights $S/depth.safetensors --intrinsics $S/lens.json
  grep -q '"from": "--intrinsics"' d.report.json
  works -v depth $S/exif.jpg -o d.png --weights $S/depth.safetensors
  says 'lens: .*EXIF'
  grep -q '"from": "EXIF"' d.report.json]=])
app_test(depth_names_a_focal_length_that_cannot_be [=[
  works depth $S/exif_odd.jpg -o d.png --weights $S/depth.safetensors
  says 'lens: 60 degrees .*, as the photo.s EXIF tells of a focal length of 1 mm for 35 mm film, which cannot be; --intr'
  grep -q '"from": "default"' d.report.json]=])
app_test(depth_takes_any_size [=[
  for f in p16x16.png p3000x500.png p20x600.png; do
    works depth $S/$f -o d.png --weights $S/depth.safetensors
    is "$(json clipped d.report.json)" -eq 0
  done
  grep -q '"fx": 519.6' d.report.json # 60 degrees along 600 pixels
  fails 1 'p500x2.png: is 500x2.*short' depth $S/p500x2.png -o e.png --weights $S/depth.safetensors]=])
app_test(depth_beyond_16_bits_is_clipped_and_counted_and_a_pfm_holds_it [=[
  works depth $S/photo.png -o d.png --weights $S/far.safetensors
  is "$(json clipped d.report.json)" -eq 6144
  says 'warning: 6144 pixels are farther than 65.535 m'
  works depth $S/photo.png -o d.pfm --weights $S/far.safetensors
  ! grep -q clipped d.report.json || complain "nothing is clipped in a PFM"
  is "$(wc -c <d.pfm)" -gt 24576]=])
app_test(depth_does_not_depend_on_threads [=[
  works --threads 1 depth $S/photo.png -o a.png --weights $S/depth.safetensors
  works --threads 3 depth $S/photo.png -o b.png --weights $S/depth.safetensors
  cmp a.png b.png]=])
app_test(depth_warns_of_weights_that_do_not_say_their_scale [=[
  works depth $S/photo.png -o a.png --weights $S/no_scale.safetensors
  says 'warning: .*no_scale.safetensors: does not say which depths.* 1 to 100 m'
  fails 1 "bad_scale.safetensors: min_z in its metadata is 'near'; expected a number" depth $S/photo.png -o b.png --weights $S/bad_scale.safetensors
  fails 1 'turned_scale.safetensors: its depth scale is unsound' depth $S/photo.png -o b.png --weights $S/turned_scale.safetensors]=])
app_test(depth_refuses_what_is_no_network_or_no_photo [=[
  fails 1 "weights.safetensors: tensor 'pts_regressor" depth $S/photo.png -o d.png --weights $S/weights.safetensors
  fails 1 'photo.png: ' depth $S/photo.png -o d.png --weights $S/photo.png
  fails 1 'absent: ' depth $S/photo.png -o d.png --weights absent
  fails 1 'nothing.jpg' depth $S/nothing.jpg -o d.png --weights $S/depth.safetensors
  fails 1 'absent.png' depth absent.png -o d.png --weights $S/depth.safetensors
  fails 2 'png or .pfm' depth $S/photo.png -o d.jpg --weights $S/depth.safetensors
  fails 1 'no_folder' depth $S/photo.png -o no_folder/d.png --weights $S/depth.safetensors
  fails 2 'required' depth $S/photo.png
  fails 2 'fov' depth $S/photo.png -o d.png --fov 180]=])
app_test(depth_never_replaces_what_it_reads [=[
  cp $S/photo.png a.png
  cp $S/photo.png b.preview.png
  cp $S/lens.json c.report.json
  fails 1 'a.png: is .*, which is read' depth a.png -o a.png --weights $S/depth.safetensors
  fails 1 'b.preview.png: is .*, which is read' depth b.preview.png -o b.png --weights $S/depth.safetensors
  fails 1 'c.report.json: is .*, which is read' depth a.png -o c.png --intrinsics c.report.json --weights $S/depth.safetensors
  cmp a.png $S/photo.png]=])
app_test(depth_that_cannot_be_written_leaves_nothing [=[
  ulimit -f 1
  trap '' XFSZ
  fails 1 'd.preview.png: writing failed' depth $S/p3000x500.png -o d.png --weights $S/depth.safetensors --fov 60]=])
app_test(scene_estimates_depth_where_none_is_given [=[
  works scene $S/photo.png --weights $S/depth.safetensors --fov 70 --no-outpaint -o s
  writes s/scene.ply s/report.json
  grep -q '"metric_depth_promised": false' s/report.json
  is "$(json points s/report.json)" -gt 1000]=])
