# SPDX-License-Identifier: BSD-3-Clause
# eval: the scores themselves are tested in tests/eval; here it is what is read, said and written.
app_test(eval_depth_scores_a_folder_and_writes_table_report_and_samples [=[
  works eval depth $S/walk --weights $S/depth.safetensors -o e.json
  writes e.json e.csv e.samples.csv
  is "$(ls | wc -l)" -eq 3
  says '^e.json: depth of 7 frames scored in [0-9.]+ s$'
  prints '^method +AbsRel +RMSE, m +delta_1 +delta_2 +delta_3$'
  prints '^method +AbsRel raw +RMSE raw, m'
  for m in ours constant 'row ramp' mean; do
    is "$(grep -c "^$m  " "$work/out")" -eq 2
    is "$(grep -c "^$m," e.csv)" -eq 10
    is "$(grep -c "^$m," e.samples.csv)" -eq 7
  done
  grep -q '^ours,"RMSE, m",[0-9.e+-]*,[0-9.e+-]*,[0-9.e+-]*,7$' e.csv
  grep -q '"layout": "RGB-D folder"' e.json
  grep -q '"verb": "eval depth"' e.json
  grep -q '"seed": 0' e.json]=])
app_test(eval_depth_of_true_depths_by_a_constant_scene_is_right_for_the_constant [=[
  cp -r $S/walk w
  for f in w/depth/*; do cp $S/depth_flat.png $f; done
  works eval depth w --weights $S/depth.safetensors -o e.json
  grep -q '^constant,AbsRel raw,0,0,0,7$' e.csv
  grep -q '^constant,delta_1 raw,1,1,1,7$' e.csv
  ! grep -q '^ours,AbsRel,0,0,0,7$' e.csv || complain "a network by chance is right"]=])
app_test(eval_depth_of_one_frame_has_no_intervals [=[
  works eval depth $S/walk --weights $S/depth.safetensors --frames 3:3 -o e.json
  says '^e.json: depth of 1 frame scored in '
  grep -Eq '^ours,AbsRel,[0-9.e+-]+,,,1$' e.csv
  ! grep -q '[.][.]' "$work/out" || complain "an interval is printed: $(cat $work/out)"
  is "$(grep -Ec '"(low|high)": null' e.json)" -eq 80
  is "$(grep -Ec '"value": [0-9]' e.json)" -eq 40]=])
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
app_test(eval_depth_takes_seven_scenes_and_says_what_it_assumes [=[
  works eval depth $S/seven --weights $S/depth.safetensors -o e.json
  says 'warning: .*seven: there is no intrinsics.json: '
  says 'depth of 2 frames'
  grep -q '"layout": "7-Scenes"' e.json
  is "$(grep '^ours,' e.samples.csv | cut -d, -f2 | xargs)" = "seq-01/frame-000000 seq-01/frame-000001"
  rm -f e.*
  cp -r $S/seven w
  echo 1 2 3 > w/seq-01/frame-000001.pose.txt
  fails 1 'frame-000001.pose.txt' eval depth w --weights $S/depth.safetensors]=])
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
  fails 2 'e.txt: .*ending in .json' eval depth $S/walk --weights $S/depth.safetensors -o e.txt
  fails 2 'ev1.csv: .*ending in .json' eval cloud $S/mixed.ply $S/mixed.ply -o ev1.csv
  fails 1 'no_folder' eval depth $S/walk --weights $S/depth.safetensors -o no_folder/e.json
  fails 2 'required' eval depth
  fails 2 '' eval]=])
app_test(eval_cloud_scores_a_cloud_against_itself_as_all_right [=[
  works eval cloud $S/mixed.ply $S/seen.pcd -o e.json
  writes e.json e.csv
  is "$(ls | wc -l)" -eq 2
  prints '^cloud +accuracy 0.01 m +completeness 0.01 m +F-score 0.01 m'
  prints '^mixed.ply +1 +1 +1$'
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

app_test(eval_cloud_counts_points_that_are_not_finite [=[
  works eval cloud $S/nan.ply $S/mixed.ply -o e.json
  is "$(grep -c warning "$work/err")" -eq 1
  says 'warning: .*nan.ply: 2 points are not finite and not scored'
  is "$(json not_finite e.json)" -eq 2
  is "$(json true_not_finite e.json)" -eq 0
  works eval cloud $S/mixed.ply $S/nan.ply -o e.json
  is "$(json not_finite e.json)" -eq 0
  is "$(json true_not_finite e.json)" -eq 2
  works eval cloud $S/mixed.ply $S/mixed.ply
  is "$(grep -c warning "$work/err")" -eq 0
  fails 1 'nans.ply: holds no point; 2 points are not finite' eval cloud $S/mixed.ply $S/nans.ply]=])
app_test(eval_ab_writes_one_page_that_needs_nothing_else [=[
  works eval ab $S/red $S/green -o page.html
  says '^page.html: 14 questions about 6 pairs in '
  is "$(ls | wc -l)" -eq 1
  head -n 1 page.html | grep -q '^<!doctype html>'
  is "$(grep -Eoc '(src|href)=.?(http|//|file)' page.html)" -eq 0
  is "$(grep -o 'data:image/jpeg;base64' page.html | wc -l)" -eq 14
  works eval ab $S/red $S/green -o lossless.html --lossless --inputs $S/green --pairs 4 --sentinels 3
  says '11 questions about 4 pairs'
  is "$(grep -o 'data:image/png;base64' lossless.html | wc -l)" -eq 11]=])
app_test(eval_ab_depends_on_the_seed_alone [=[
  works --seed 1 --threads 1 eval ab $S/red $S/green -o a.html
  works --seed 1 --threads 3 eval ab $S/red $S/green -o b.html
  works --seed 2 eval ab $S/red $S/green -o c.html
  cmp a.html b.html
  ! cmp -s a.html c.html || complain "the seed changes nothing"]=])
app_test(eval_ab_names_cannot_break_the_page [=[
  mkdir a b
  cp $S/red/p0.png 'a/<script>"&.png'
  cp $S/green/p0.png 'b/<script>"&.png'
  works eval ab a b -o page.html --question '</script><b>' --names '</script>,<!--'
  is "$(grep -o '</script>' page.html | wc -l)" -eq 2]=])
app_test(eval_ab_pairs_equal_names_of_equal_sizes [=[
  cp -r $S/red a
  rm a/p0.png a/p1.png
  cp $S/photo.png a/other.png
  works eval ab a $S/green -o page.html
  says 'warning: 3 images are in one folder alone'
  works eval ab $S/red $S/green -o one.html --pairs 1 --sentinels 0
  says '^one.html: 2 questions about 1 pair in '
  rm one.html
  works eval ab a $S/green -o page.html
  says 'about 4 pairs'
  cp $S/photo.png a/p2.png
  fails 1 'p2.png: is 64x48 pixels.*96x64; expected one size' eval ab a $S/green -o b.html
  cp a/p3.png a/p2.bmp
  fails 1 'another image has its name' eval ab a $S/green -o b.html
  fails 1 'no image has the name' eval ab $S/red $S/tum -o b.html
  fails 1 'has no image p0' eval ab $S/red $S/green --inputs $S/tum -o b.html
  fails 1 'absent' eval ab absent $S/green -o b.html
  ln -s $S/red again
  fails 1 'again: is .*/red, A.s folder; expected pictures of another method' eval ab $S/red again -o b.html
  fails 1 'red/.: is .*/red, A.s folder' eval ab $S/red $S/red/. -o b.html
  fails 2 'ending in .html' eval ab $S/red $S/green -o b.txt
  fails 2 'names' eval ab $S/red $S/green -o b.html --names one
  fails 2 'sentinels' eval ab $S/red $S/green -o b.html --sentinels -1]=])

# answered PAGE WAY: a page's result after ab_voter.js has answered all of it, in a browser without a screen.
set(in_browser "
  needs chromium
  answered() {
    (cat $1; echo '<script>'; cat ${CMAKE_CURRENT_SOURCE_DIR}/ab_voter.js; echo \"vote('$2')</script>\") >$work/answered.html
    chromium --headless --no-sandbox --disable-gpu --user-data-dir=$work/browser --virtual-time-budget=60000 --dump-dom file://$work/answered.html 2>$work/browser.txt >$work/dom.html
    sed -n '/<pre id=.result.>{/,/^}/p' $work/dom.html
  }")
app_test(eval_ab_result_says_whose_pictures_were_taken "${in_browser}
  works --seed 3 eval ab $S/red $S/green -o page.html --names ours,theirs
  answered page.html looks > result
  for claim in '\"a\": \"ours\"' '\"pairs\": 6' '\"a_wins\": 6' '\"b_wins\": 0' '\"votes_disagree\": 0' '\"a_share\": 1' '\"sentinels\": 2' '\"sentinels_right\": 2' '\"trials\": 14'; do
    grep -q \"$claim\" result || complain \"the result lacks $claim: $(cat result)\"
  done
  works --seed 3 eval ab $S/green $S/red -o page.html
  answered page.html looks > result
  grep -q '\"a\": \"green\"' result
  grep -q '\"b_wins\": 6' result
  grep -q 'href=.data:application/json' $work/dom.html")
app_test(eval_ab_counts_no_pair_for_who_always_takes_one_side "${in_browser}
  works eval ab $S/red $S/green -o page.html --sentinels 0 --inputs $S/green
  answered page.html left > result
  for claim in '\"a_wins\": 0' '\"b_wins\": 0' '\"votes_disagree\": 6' '\"a_share\": null' '\"left_chosen\": 12' '\"trials\": 12'; do
    grep -q \"$claim\" result || complain \"the result lacks $claim: $(cat result)\"
  done")
