# SPDX-License-Identifier: BSD-3-Clause
# eval: the scores themselves are tested in tests/eval; here it is what is read, said and written.
app_test(eval_depth_scores_a_folder_and_writes_table_report_and_samples [=[
  works eval depth $S/walk --weights $S/depth.safetensors -o e.json
  writes e.json e.csv e.samples.csv
  is "$(ls | wc -l)" -eq 3
  says '^e.json: depth of 7 frames scored in [0-9.]+ s$'
  prints '^method +AbsRel +RMSE, m +delta_1 +delta_2 +delta_3$'
  prints '^method +AbsRel raw +RMSE raw, m'
  for m in ours constant 'row ramp'; do
    is "$(grep -c "^$m  " "$work/out")" -eq 2
    is "$(grep -c "^$m," e.csv)" -eq 10
    is "$(grep -c "^$m," e.samples.csv)" -eq 7
  done
  grep -q '^ours,"RMSE, m",[0-9.e+-]*,[0-9.e+-]*,[0-9.e+-]*,7$' e.csv
  grep -q '"layout": "RGB-D folder"' e.json
  grep -q '"seed": 0' e.json]=])
app_test(eval_depth_of_true_depths_by_a_constant_scene_is_right_for_the_constant [=[
  cp -r $S/walk w
  for f in w/depth/*; do cp $S/flat.png $f; done
  works eval depth w --weights $S/depth.safetensors -o e.json
  grep -q '^constant,AbsRel raw,0,0,0,7$' e.csv
  grep -q '^constant,delta_1 raw,1,1,1,7$' e.csv
  ! grep -q '^ours,AbsRel,0,0,0,7$' e.csv || complain "a network by chance is right"]=])
app_test(eval_depth_json_is_the_report_and_no_table [=[
  works --json eval depth $S/walk --weights $S/depth.safetensors
  prints '^  "methods": '
  ! grep -q '^method' "$work/out" || complain "the table is printed too"
  is -n "$(json peak_memory_mib "$work/out")"
  is "$(ls | wc -l)" -eq 0]=])
app_test(eval_depth_takes_some_frames [=[
  works eval depth $S/walk --weights $S/depth.safetensors --frames 2:5 --every 2 -o e.json
  is "$(grep '^ours,' e.samples.csv | cut -d, -f2 | xargs)" = "00002 00004"
  fails 1 'no frame is in 100:' eval depth $S/walk --weights $S/depth.safetensors --frames 100:
  fails 2 'frames' eval depth $S/walk --weights $S/depth.safetensors --frames x
  fails 2 'every' eval depth $S/walk --weights $S/depth.safetensors --every 0]=])
app_test(eval_depth_does_not_depend_on_threads_and_its_intervals_on_the_seed_alone [=[
  works --threads 1 eval depth $S/walk --weights $S/depth.safetensors -o a.json
  works --threads 3 eval depth $S/walk --weights $S/depth.safetensors -o b.json
  works --seed 4 eval depth $S/walk --weights $S/depth.safetensors -o c.json
  cmp a.csv b.csv
  cmp a.samples.csv b.samples.csv
  cmp a.samples.csv c.samples.csv
  ! cmp -s a.csv c.csv || complain "the seed changes nothing"]=])
app_test(eval_depth_takes_rooms_by_seed [=[
  works eval depth rooms:5:3 --weights $S/depth.safetensors -o e.json
  is "$(grep -c '^ours,' e.samples.csv)" -eq 3
  fails 1 'rooms:SEED:COUNT' eval depth rooms:5 --weights $S/depth.safetensors]=])
app_test(eval_depth_takes_tum_and_says_what_it_assumes [=[
  works eval depth $S/tum --weights $S/depth.safetensors
  says 'warning: .*tum: there is no intrinsics.json: a focal length of 525 pixels'
  says 'depth of 2 frames']=])
app_test(eval_depth_leaves_frames_without_depth_out_and_refuses_data_without_any [=[
  cp -r $S/walk w
  for i in 1 2 4; do cp $S/zero.png w/depth/0000$i.png; done
  works eval depth w --weights $S/depth.safetensors
  says 'depth of 4 frames'
  for f in w/depth/*; do cp $S/zero.png $f; done
  fails 1 'no frame has any depth' eval depth w --weights $S/depth.safetensors
  fails 1 'no frame has any depth' eval depth $S/estate --weights $S/depth.safetensors]=])
app_test(eval_depth_refuses_what_is_no_data_and_what_cannot_be_written [=[
  fails 1 'absent: is not there' eval depth absent --weights $S/depth.safetensors
  fails 1 'no_depth: is of no known layout' eval depth $S/no_depth --weights $S/depth.safetensors
  fails 1 'ending in .json' eval depth $S/walk --weights $S/depth.safetensors -o e.txt
  fails 1 'no_folder' eval depth $S/walk --weights $S/depth.safetensors -o no_folder/e.json
  fails 2 'required' eval depth
  fails 2 '' eval]=])
app_test(eval_cloud_scores_a_cloud_against_itself_as_all_right [=[
  works eval cloud $S/mixed.ply $S/seen.pcd -o e.json
  writes e.json e.csv
  is "$(ls | wc -l)" -eq 2
  prints '^cloud +accuracy 0.01 m +completeness 0.01 m +F-score 0.01 m'
  prints '^mixed.ply +1 +1 +1 '
  grep -q '^mixed.ply,"chamfer, m",0,0,0,' e.csv
  says '^e.json: [0-9]+ points scored against [0-9]+ in ']=])
app_test(eval_cloud_takes_thresholds_and_knows_which_is_the_truth [=[
  works fuse $S/walk -o whole.ply
  works fuse $S/walk -o some.ply --frames 0:1
  works --json eval cloud some.ply whole.ply --thresholds 0.05,0.2
  prints '"completeness 0.2 m"'
  works eval cloud some.ply whole.ply --thresholds 0.05 -o a.json
  works eval cloud whole.ply some.ply --thresholds 0.05 -o b.json
  is "$(grep 'accuracy' a.csv | cut -d, -f3)" = "$(grep 'completeness' b.csv | cut -d, -f3)"
  is "$(grep 'accuracy' a.csv | cut -d, -f3)" != "$(grep 'completeness' a.csv | cut -d, -f3)"
  fails 2 'thresholds' eval cloud some.ply whole.ply --thresholds 0
  fails 2 'block' eval cloud some.ply whole.ply --block -1]=])
app_test(eval_cloud_refuses_empty_clouds_and_never_replaces_what_it_reads [=[
  cp $S/mixed.ply a.ply
  fails 1 'empty.ply: holds no point' eval cloud a.ply $S/empty.ply
  fails 1 'nans.ply: holds no point' eval cloud $S/nans.ply a.ply
  fails 1 'absent.ply' eval cloud absent.ply a.ply
  fails 1 'photo.png' eval cloud $S/photo.png a.ply
  ln -s a.ply b.csv
  fails 1 'b.csv: is .*, which is read' eval cloud a.ply $S/mixed.ply -o b.json]=])
