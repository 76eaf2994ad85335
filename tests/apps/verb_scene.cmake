# SPDX-License-Identifier: BSD-3-Clause
# `scene` with the shipped weights: outpainting, resuming, odd photos.
app_test(scene_outpaints_what_the_photo_does_not_show [=[
  works --json scene $S/photo.png --depth $S/depth.png --fov 70 -o s --samples 1 --directions left,up
  writes s/scene.ply s/preview.png s/trajectory.txt s/intrinsics.json s/report.json s/settings.json
  for v in input left_1 left up_1 up; do writes s/views/$v.png; done
  is "$(ls s/views | wc -l)" -eq 5
  is "$(size_of s/views/left.png)" = 384x256
  is "$(json outpainted s/report.json)" -gt 10000
  is "$(json observed s/report.json)" -gt 10000
  for key in seam_step residual '"sampled"' '"spared"' '"kept"' refused_in_free_space '"encode"'; do
    grep -q "$key" s/report.json || complain "$key is missing"
  done
  is ! -e s.work]=])
app_test(scene_needs_nothing_but_a_photo [=[
  works scene $S/photo.png --fov 70 -o s --samples 1 --directions left,up
  is "$(json outpainted s/report.json)" -gt 10000]=])
app_test(scene_does_not_depend_on_threads [=[
  works --threads 1 scene $S/photo.png --fov 70 -o a --samples 3 --directions left,up
  works --threads 3 scene $S/photo.png --fov 70 -o b --samples 3 --directions left,up
  cmp a/scene.ply b/scene.ply
  cmp a/views/left.png b/views/left.png]=])
app_test(scene_seed_decides_what_is_invented [=[
  works --seed 1 scene $S/photo.png --fov 70 -o a --samples 1 --directions left
  works --seed 2 scene $S/photo.png --fov 70 -o b --samples 1 --directions left
  ! cmp -s a/scene.ply b/scene.ply || complain "the seed changes nothing"]=])
app_test(scene_guidance_holds_what_is_invented_to_what_is_seen [=[
  for g in 0 1 1000; do works scene $S/photo.png --fov 70 -o g$g --samples 1 --directions left --guidance $g; done
  works scene $S/photo.png --fov 70 -o default --samples 1 --directions left
  cmp default/scene.ply g1/scene.ply
  ! cmp -s g0/scene.ply g1/scene.ply || complain "the guidance changes nothing"
  ! cmp -s g1/scene.ply g1000/scene.ply || complain "more guidance changes nothing"
  for g in -1 1001 x; do fails 2 'guidance' scene $S/photo.png -o t --guidance $g; done]=])
app_test(scene_goes_on_after_an_interruption_to_the_same_bytes [=[
  args="$S/photo.png --fov 70 --samples 8 --directions left,right,up,down"
  works scene $args -o whole
  env --default-signal=INT $program -q scene $args -o s &
  for i in $(seq 600); do
    [ ! -e s.work/1.safetensors ] || break
    sleep 0.1
  done
  kill -INT $!
  wait $! || true
  is -e s.work/1.safetensors
  is ! -e s
  fails 1 's.work: is of a run with other settings.*resume' -q scene $args --seed 9 -o s --resume
  works scene $args -o s --resume
  grep -q '"resumed": true' s/report.json
  cmp s/scene.ply whole/scene.ply
  cmp s/views/down.png whole/views/down.png
  is ! -e s.work]=])
app_test(scene_strategies_differ [=[
  for s in support sequential independent; do
    works scene $S/photo.png --fov 70 -o $s --samples 1 --directions left --strategy $s
  done
  is "$(grep -c '"missing_share".*' support/report.json)" -lt "$(grep -c '"missing_share"' sequential/report.json)"
  ! cmp -s sequential/views/left.png independent/views/left.png || complain "they look alike"]=])
app_test(scene_outpaints_further_views_of_a_trajectory [=[
  echo '0 0.2 0 0 0.996 0 0.087 0' > poses.txt
  works scene $S/photo.png --fov 70 -o s --samples 1 --directions left --support-views poses.txt
  writes s/views/support_1.png
  fails 1 'absent.txt' scene $S/photo.png --fov 70 -o t --samples 1 --support-views absent.txt]=])
app_test(scene_makes_videos_that_browsers_play [=[
  needs ffprobe
  works scene $S/photo.png --fov 70 -o s --samples 1 --directions left --paths sway,left --path-frames 4
  writes s/sway.mp4 s/left.mp4
  ffprobe -v error -show_entries stream=codec_name,pix_fmt,nb_frames -of csv=p=0 s/sway.mp4 > probe.txt
  grep -qx 'h264,yuv420p,4' probe.txt || complain "$(cat probe.txt)"
  fails 1 'absent.txt' scene $S/photo.png -o t --paths absent.txt
  fails 2 'two of them would be sway' scene $S/photo.png -o t --paths sway,sway]=])
app_test(scene_continues_a_folder_of_frames [=[
  works scene $S/walk -o s --samples 1 --directions left
  is "$(json outpainted s/report.json)" -gt 1000
  is "$(json observed s/report.json)" -gt 5000
  fails 2 'own depth' scene $S/walk --depth $S/depth.png -o t]=])
app_test(scene_of_odd_photos_is_made_or_refused_in_one_line [=[
  for p in p16x16 p20x600 grey deep alpha flat noise; do
    works scene $S/$p.png --fov 60 -o $p --samples 1 --directions left
    writes $p/scene.ply
  done
  fails 1 'p500x2.png: is 500x2.*100 short' scene $S/p500x2.png --fov 60 -o t --samples 1]=])
app_test(scene_of_odd_ranges [=[
  works scene $S/photo.png --fov 70 -o s --samples 1 --directions left --range-horizontal 0
  grep -q 'nothing is missing' s/report.json
  is "$(json outpainted s/report.json)" -eq 0
  works scene $S/photo.png --fov 70 -o t --samples 1 --directions left --range-horizontal 180deg
  is "$(json outpainted t/report.json)" -gt 10000]=])
app_test(scene_of_odd_depths [=[
  for d in equal holes near; do
    works scene $S/photo.png --depth $S/depth_$d.png --fov 70 -o $d --samples 1 --directions left
    is "$(json outpainted $d/report.json)" -gt 1000
  done
  grep -A3 '"filled"' holes/report.json | grep -q pixels]=])
app_test(scene_takes_one_file_of_all_networks_as_published [=[
  args="scene $S/photo.png --fov 60 --samples 1 --directions left"
  works $args -o s --select discriminator --weights $S/published.safetensors
  is "$(json outpainted s/report.json)" -gt 1000
  is "$(grep -c 'does not say which depths' "$work/err")" -eq 0
  works weights convert $S/published.safetensors -o all.safetensors
  works $args -o t --select discriminator --weights all.safetensors
  cmp s/scene.ply t/scene.ply
  works depth $S/photo.png --fov 60 -o d.pfm --weights all.safetensors --json
  fails 1 'published.safetensors.*classifier.*--select discriminator' -q $args -o u --select both --weights $S/published.safetensors]=])
app_test(scene_through_a_long_lens_keeps_its_pixels [=[
  for fov in 2 5 10; do
    works scene $S/photo.png --fov $fov --no-outpaint -o s
    is "$(sed -n 's/.*"lifted": \([0-9]*\).*/\1/p' s/report.json)" -ge 5837
  done]=])
app_test(scene_keeps_to_a_budget [=[
  args="$S/photo.png --depth $S/depth.png --fov 70 --samples 1 --directions left"
  works scene $args -o all --budget none
  works scene $args -o some --budget points=20000
  works scene $args -o auto
  all=$(json points all/report.json) some=$(json points some/report.json) auto=$(json points auto/report.json)
  is $all -gt 100000
  is $some -le 21000
  is $some -gt 15000
  is $auto -lt $((all * 4 / 5))
  works scene $args -o near --budget psnr=35
  is "$(json points near/report.json)" -lt $all
  works scene $args -o one --budget points=1
  left=$(json points one/report.json)
  is $left -lt 20
  says "warning: --budget points=1: $left points stay, as observed and outpainted"
  grep -q '"points_asked": 1' one/report.json
  for b in few points=0 psnr=x points= points=1.5 ''; do
    fails 2 "'$b'; expected none, auto, points=N or psnr=DB" scene $args -o t --budget "$b"
  done]=])
app_test(scene_refuses_what_it_cannot_do [=[
  fails 2 "'35grad' is no angle.*34deg" scene $S/photo.png -o a --range-horizontal 35grad
  fails 2 "'0'; expected 1 to 1000, or auto" scene $S/photo.png -o a --samples 0
  fails 2 'refine-best' scene $S/photo.png -o a --samples auto --refine-best 3
  fails 2 'refine-best.*likelihood' scene $S/photo.png -o a --refine-best 3 --select likelihood
  fails 2 'refine-best.*consensus.*expected discriminator' scene $S/photo.png -o a --refine-best 3
  fails 2 'directions' scene $S/photo.png -o a --directions back
  fails 2 'left is given twice' scene $S/photo.png -o a --directions left,up,left
  fails 1 'vqvae.safetensors' scene $S/photo.png -o a --weights $S
  fails 1 'absent' scene $S/photo.png -o a --weights absent.pth]=])
