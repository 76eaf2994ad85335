# SPDX-License-Identifier: BSD-3-Clause
app_test(eval_views_scores_what_needs_no_networks [=[
  plain="--methods mean-colour,telea,navier-stokes,nearest,copy --min-rotation 0 --pairs 2"
  works eval views rooms:5:4 $plain -o v.json --pictures p
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
app_test(eval_views_takes_depth_that_is_zero_everywhere_for_none [=[
  args="--frames 0:1 --min-rotation 0 --pairs 1 --methods copy"
  cp -r $S/walk w
  for d in w/depth/*; do
    cp $S/zero.png $d
    works eval views w $args -o v.json
    grep -Eq '^copy,"PSNR visible, dB",[0-9.]+,' v.csv || complain "nothing is visible without $d"
    grep -q '"visible_share": 0.[0-9]*[1-9]' v.json
  done]=])
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
app_test(eval_views_refuses_other_methods_and_ranges_without_pairs [=[
  fails 2 'methods.*best' eval views $S/walk --methods best
  fails 2 'wide' eval views $S/walk --wide --min-rotation 5
  fails 1 'absent' eval views absent
  fails 1 'walk: no two of its frames are 170 to 180 degrees and at most 1 m apart' eval views $S/walk --min-rotation 170 --max-rotation 180 --methods copy
  fails 1 'rotations' eval views $S/walk --min-rotation 50 --max-rotation 40 --methods copy]=])
