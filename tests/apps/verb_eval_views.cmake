# SPDX-License-Identifier: BSD-3-Clause
app_test(eval_views_scores_what_needs_no_networks [=[
  plain="--methods mean-colour,telea,navier-stokes,nearest,copy --min-rotation 0 --pairs 2"
  mkdir -p p/copy p/no-outpainter
  touch p/no-outpainter/pair_00000.png p/copy/pair_00007.png p/copy/pair.png p/mine.png
  works eval views rooms:5:4 $plain -o v.json --pictures p
  is ! -e p/no-outpainter
  is ! -e p/copy/pair_00007.png
  is -e p/copy/pair.png
  is -e p/mine.png
  writes v.json v.csv v.samples.csv
  says '^v.json: views of 2 pairs scored in [0-9.]+ s$'
  prints '^method +PSNR, dB +PSNR visible, dB +PSNR invisible, dB +SSIM +LPIPS-squeeze$'
  grep -q '"rotation"' v.json
  for m in mean-colour telea navier-stokes nearest copy; do
    for score in '"PSNR, dB"' '"PSNR visible, dB"' '"PSNR invisible, dB"' SSIM '"seconds, s"'; do
      grep -Eq "^$m,$score,[0-9.]+,[0-9.]+,[0-9.]+,2$" v.csv || complain "$m has no $score"
    done
    grep -q "^$m,LPIPS-squeeze,,,,0$" v.csv || complain "$m has LPIPS without a network"
    is "$(grep -c "^$m," v.samples.csv)" -eq 2
    writes p/$m/pair_00000.png p/$m/pair_00001.png
  done
  writes p/input/pair_00001.png p/truth/pair_00001.png p/pair_00000.png p/pair_00001.png
  cmp p/copy/pair_00000.png p/input/pair_00000.png
  ! cmp -s p/nearest/pair_00000.png p/truth/pair_00000.png || complain "the truth is shown"]=])
app_test(eval_views_scores_no_visible_part_without_true_depth_of_both_frames [=[
  args="--min-rotation 0 --pairs 2 --methods copy"
  works eval views $S/walk --frames 0:1 $args -o v.json
  ! grep -q warning "$work/err" || complain "there is a warning"
  grep -Eq '^copy,"PSNR visible, dB",[0-9.]+,' v.csv
  grep -q '"visible_share": 0.[0-9]*[1-9]' v.json
  cp -r $S/walk w
  cp $S/zero.png w/depth/00001.png
  works eval views w --frames 0:1 $args -o v.json
  is "$(grep -c 'warning: w: 2 of 2 pairs without true depth of both frames' "$work/err")" -eq 1
  is "$(grep -c warning "$work/err")" -eq 1
  is "$(grep -c 'visible_share": null' v.json)" -eq 4
  for part in visible invisible; do grep -q "^copy,\"PSNR $part, dB\",,,,0$" v.csv; done
  grep -Eq '^copy,[^,]*,[0-9]+,[0-9.]+,,,' v.samples.csv
  prints '^copy +[0-9.]+ +- +- '
  works eval views w --frames 0:2 --min-rotation 0 --pairs 6 --methods copy -o v.json
  says 'warning: w: 4 of 6 pairs without'
  grep -Eq '^copy,"PSNR visible, dB",[0-9.]+,.*,2$' v.csv
  works eval views $S/estate $args
  says 'warning: .*estate: 2 of 2 pairs without true depth'
  prints '^copy +inf +- +- ']=])
app_test(eval_views_of_one_pair_has_no_intervals [=[
  works eval views rooms:5:4 --methods copy --min-rotation 0 --pairs 1 -o v.json
  says '^v.json: views of 1 pair scored in '
  grep -Eq '^copy,"PSNR, dB",[0-9.]+,,,1$' v.csv
  ! grep -q '[.][.]' "$work/out" || complain "an interval is printed"
  grep -q '"low": null' v.json
  ! grep -Eq '"(low|high)": [0-9]' v.json || complain "there is an interval"]=])
app_test(eval_views_builds_no_more_rooms_than_its_pairs_need [=[
  works eval views rooms:5:400000 --methods copy --pairs 2
  says 'views of 2 pairs scored']=])
app_test(eval_views_reads_the_networks_that_its_methods_need "
  mkdir w
  cp $S/depth.safetensors w
  plain='eval views '$S'/walk --frames 0:1 --min-rotation 0 --pairs 1 --weights w'
  works $plain --methods copy
  fails 1 'w/refine.safetensors' $plain --methods no-outpainter
  cp ${PROJECT_SOURCE_DIR}/data/weights/refine.safetensors w
  works $plain --methods no-outpainter,copy
  fails 1 'w/(vqvae|pixelcnn).safetensors' $plain --methods one-completion")
app_test(eval_views_gives_the_same_bytes_again_whatever_the_threads [=[
  again="$S/walk --min-rotation 0 --pairs 1 --samples 1 --methods ours,telea"
  works --threads 1 eval views $again -o a.json --pictures a
  works --threads 3 eval views $again -o b.json --pictures b
  for f in a b; do grep -v '"seconds, s"' $f.csv > $f.txt; sed 's/,[^,]*$//' $f.samples.csv > $f.samples.txt; done
  is "$(wc -l < a.txt)" -eq 11
  cmp a.txt b.txt
  cmp a.samples.txt b.samples.txt
  diff -r a b
  works --seed 9 eval views $again -o c.json
  sed 's/,[^,]*$//' c.samples.csv > c.samples.txt
  ! cmp -s a.samples.txt c.samples.txt || complain "the seed changes nothing"]=])
app_test(eval_views_outpaints_and_names_what_its_frechet_distance_is_on [=[
  works eval views $S/walk --frames 0:3 --min-rotation 0 --pairs 2 --samples 1 --methods one-completion,no-outpainter,copy --lpips $S/lpips.safetensors -o v.json
  prints 'Frechet distance on SqueezeNet 1.1 fire-9 features'
  ! grep -Eq '(^|[^A-Z])FID' v.json || complain "it is called FID"
  grep -Eq '^one-completion,Frechet distance on SqueezeNet 1.1 fire-9 features,[0-9.]+,,,2$' v.csv
  grep -Eq '^one-completion,LPIPS-squeeze,[0-9.]+,' v.csv]=])
# What stands in the way comes after the checks, while the run works.
app_test(eval_views_writes_scores_and_pictures_together_or_not_at_all [=[
  for wall in v.csv p; do
    "$program" -q eval views rooms:5:8 --methods telea,copy --min-rotation 0 --pairs 8 -o v.json --pictures p 2>"$work/err" & pid=$!
    for i in $(seq 300); do
      [ ! -d p.partial-$pid ] || break
      sleep 0.02
    done
    is -d p.partial-$pid
    [ $wall != v.csv ] || mkdir v.csv
    [ $wall != p ] || touch p
    ! wait $pid || complain "it succeeded"
    says " $wall: "
    is ! -s v.json
    is ! -s v.samples.csv
    [ $wall != v.csv ] || is ! -e p
    rm -r $wall
    is "$(find . | wc -l)" -eq 1
  done]=])
app_test(eval_views_refuses_other_methods_and_ranges_without_pairs [=[
  fails 2 'methods.*best' eval views $S/walk --methods best
  fails 2 'wide' eval views $S/walk --wide --min-rotation 5
  fails 1 'absent' eval views absent
  fails 1 'walk: no two of its frames are 170 to 180 degrees and at most 1 m apart' eval views $S/walk --min-rotation 170 --max-rotation 180 --methods copy
  fails 2 'min-rotation: 50 is more than --max-rotation 40' eval views $S/walk --min-rotation 50 --max-rotation 40 --methods copy
  fails 2 'min-rotation: 90 is more than --max-rotation 60' eval views $S/walk --min-rotation 90 --methods copy]=])
app_test(eval_views_takes_seven_scenes [=[
  works eval views $S/seven --min-rotation 5 --max-rotation 20 --methods copy,nearest --pairs 2 -o v.json
  says 'views of 2 pairs scored'
  grep -q '"layout": "7-Scenes"' v.json
  grep -Eq '^nearest,"PSNR visible, dB",[0-9.]+,' v.csv]=])
