# SPDX-License-Identifier: BSD-3-Clause
# train, with networks of a few channels and steps; built only where libtorch is.
app_test(train_needs_a_stage_and_its_folders [=[
  fails 2 'subcommand is required' train
  fails 2 'data is required' train depth -o r
  fails 2 'output is required' train all --data d
  fails 2 'codes is required' train refine --data d -o r
  fails 2 'codes is required' train pixelcnn --data d -o r
  fails 2 'either --rooms or --rgbd' train data -o d
  fails 2 'either --rooms or --rgbd' train data -o d --rooms 1 --rgbd $S/walk
  fails 2 'poses-only.*rgbd' train data -o d --rooms 1 --poses-only]=])
app_test(train_stages_have_help [=[for v in data all vqvae depth refine pixelcnn classifier; do works train $v --help; prints Options; done]=])
app_test(train_options_are_checked [=[
  fails 2 "width" train depth --data d -o r --width wide
  fails 2 "width" train all --data d -o r --width 513
  fails 2 "steps-scale.*out of range" train all --data d -o r --steps-scale 0
  fails 2 'supervision.*poses' train depth --data d -o r --supervision hope
  fails 2 'supervision' train vqvae --data d -o r --supervision poses
  fails 2 'curriculum' train refine --data d -o r --codes c --curriculum -1
  fails 2 'curriculum' train classifier --data d -o r --curriculum 5
  fails 2 'steps' train all --data d -o r --steps 5
  fails 2 'keep-codes requires --init; see pixelsynth train vqvae --help' train vqvae --data d -o r --keep-codes]=])
app_test(train_names_what_is_missing [=[
  fails 1 'd/train: there are no examples' train depth --data d -o r
  fails 1 'absent' train data -o absent/d --rgbd $S/absent
  fails 1 'c: ' train refine --data d -o r --codes c]=])
app_test(train_data_looks_at_no_depth_when_poses_alone_are_asked_for [=[
  cp -r $S/walk w
  rm -r w/depth
  works train data -o d/train --rgbd w --poses-only --pairs-per-frame 1
  writes d/train/posed-0000.safetensors
  fails 1 "d/train: no example's depth is known.*supervision poses" train depth --data d -o r --threads 1
  works --threads 1 train depth --data d -o r --supervision poses --width 2 --batch 2 --steps 1
  writes r/weights.safetensors]=])
app_test(train_all_trains_every_stage_and_goes_on [=[
  works train data -o d/train --rooms 1 --seed 1
  works train data -o d/test --rooms 1 --seed 2
  a="--threads 1 train all --data d -o r --width 4 --batch 2 --steps-scale 0.0002 --test-count 1"
  works $a
  for stage in vqvae depth refine pixelcnn classifier; do
    writes r/$stage/weights.safetensors r/$stage/report.json r/$stage/settings.json r/$stage/sheet.png r/$stage/log.csv
    says "r/$stage: $stage, step [1-9]"
  done
  writes r/report.json
  cp -r r before
  rm -r r/refine r/pixelcnn
  works $a
  for stage in vqvae depth refine pixelcnn classifier; do
    cmp r/$stage/weights.safetensors before/$stage/weights.safetensors
  done
  works depth $S/photo.png -o p.png --weights r/depth/weights.safetensors --fov 60]=])
