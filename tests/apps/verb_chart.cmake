# SPDX-License-Identifier: BSD-3-Clause
# chart: knobs and fronts are tested in tests/eval and tests/scene, pictures in chart_picture_test.cpp.
app_test(chart_writes_tables_pictures_and_a_page [=[
  works --threads 1 chart -o c --views 1 --side 64 --knobs radius,image-size
  writes c/chart.csv c/chart.json c/chart.png c/index.html
  for k in radius image-size; do
    writes c/$k.png c/$k.svg c/$k.samples.csv
    is "$(size_of c/$k.png)" = 1080x720
    is "$(grep -c '<svg ' c/$k.svg)" -eq 1
    is "$(grep -c '<circle' c/$k.svg)" -eq "$(($(grep -c "^$k," c/chart.csv) + 3))"
    is "$(grep -c "^$k,[^,]*,1," c/chart.csv)" -eq 1
  done
  is "$(size_of c/chart.png)" = 2160x720
  is "$(ls c | wc -l)" -eq 10
  is "$(grep -c '^radius,' c/chart.csv)" -eq 10
  grep -q '"processor": ' c/chart.json
  grep -q '"seed": 0' c/chart.json
  head -n 1 c/index.html | grep -q '^<!doctype html>'
  is "$(grep -o 'data:image/jpeg;base64' c/index.html | wc -l)" -eq $((10 + 5 + 2 * 2))
  is "$(grep -Eoc '(src|href)=.?(http|//|file)' c/index.html)" -eq 0
  for s in 1 2 3 4 5 6 7 8 9 10; do
    is "$(grep -c "href=\"#radius-$s\"" c/index.html)" -eq 1
    is "$(grep -c "id=\"radius-$s\"" c/index.html)" -eq 1
  done
  prints '^radius +seconds, s +PSNR where known, dB +change, dB'
  prints '^1 to 4 [*]'
  says '^c: 2 knobs on 1 pair of views in ']=])
app_test(chart_of_one_sample_has_no_intervals [=[
  works chart -o c --views 1 --side 64 --knobs image-size
  is "$(grep -Ec '^image-size,[^,]*,[01],[01],"[^"]*",[0-9.e+-]+,,,[0-9.]+,,,[0-9.e+-]+,,,1$' c/chart.csv)" -eq 5
  is "$(grep -c '<small>' c/index.html)" -eq 0
  is "$(grep -Ec '"(low|high)": null' c/chart.json)" -eq 30
  ! grep -q 'intervals' c/image-size.svg || complain "the legend promises intervals"]=])
app_test(chart_in_an_old_folder_leaves_nothing_of_other_knobs [=[
  mkdir c
  touch c/radius.png c/radius.svg c/radius.samples.csv c/width.svg c/radius.txt c/mine.png
  works chart -o c --views 1 --side 64 --knobs image-size
  is "$(LC_ALL=C ls c | xargs)" = "chart.csv chart.json chart.png image-size.png image-size.samples.csv image-size.svg index.html mine.png radius.txt"]=])
app_test(chart_says_which_knobs_lpips_does_not_score [=[
  works chart --help
  prints 'lpips.*samples, guidance and selection alone'
  works chart -o c --views 1 --side 64 --knobs radius,image-size --lpips $S/lpips.safetensors
  says '^--lpips scores samples, guidance and selection alone, not radius, image-size$'
  fails 1 'absent' chart -o d --views 1 --side 64 --knobs radius --lpips absent]=])
app_test(chart_png_is_drawn_as_the_svg_says [=[
  needs ffmpeg
  works chart -o c --views 1 --side 64 --knobs radius
  is "$(pixel c/radius.png 2 2)" = "255 255 255"
  for dot in $(sed -n 's/.*<a href.*<circle cx="\([0-9.]*\)" cy="\([0-9.]*\)".*/\1,\2/p' c/radius.svg); do
    x=$(awk "BEGIN { printf \"%d\", 1.5 * ${dot%,*} }") y=$(awk "BEGIN { printf \"%d\", 1.5 * ${dot#*,} }")
    is "$(pixel c/radius.png $x $y)" = "0 114 178"
  done]=])
app_test(chart_svg_is_xml [=[
  needs python3
  works chart -o c --views 1 --side 64 --knobs radius
  python3 -c 'import sys, xml.dom.minidom as x; print(x.parse(sys.argv[1]).documentElement.tagName)' c/radius.svg >"$work/out"
  prints '^svg$']=])
app_test(chart_scores_do_not_depend_on_threads_but_on_the_seed [=[
  works --threads 1 chart -o a --views 1 --side 64 --knobs radius
  works --threads 3 chart -o b --views 1 --side 64 --knobs radius
  works --seed 1 chart -o c --views 1 --side 64 --knobs radius
  scores() { cut -d, -f1-3,10- $1/chart.csv; }
  is "$(scores a)" = "$(scores b)"
  is "$(scores a)" != "$(scores c)"]=])
app_test(chart_takes_frames_and_refuses_those_without_pairs_or_depth [=[
  works chart rooms:5:8 -o c --views 2 --knobs image-size
  says '^c: 1 knob on 2 pairs of views in '
  is "$(grep -Ec '<small>[0-9.e+-]+ to [0-9.e+-]+</small>' c/index.html)" -ge 5
  is "$(grep -o '<small>' c/index.html | wc -l)" -eq $((5 * 3))
  grep -q 'with 95 % intervals' c/image-size.svg
  fails 1 'no two frames are a pair' chart rooms:5:1 -o d --knobs radius
  fails 1 'absent' chart absent -o d --knobs radius
  cp -r $S/estate e
  sed -i '$s/ 1 0 0 0 0 1 0 0 0 0 1 0$/ 0.8660254 0 0.5 0 0 1 0 0 -0.5 0 0.8660254 0/' e/clip.txt
  fails 1 'has no depth; expected' chart e -o d --knobs radius]=])
app_test(chart_names_its_knobs_and_sizes [=[
  fails 2 'knobs.*samples.*selection.*radius.*points-per-pixel.*budget.*image-size.*arithmetic.*width' chart -o c --knobs speed
  fails 2 'size.*small' chart -o c --size huge
  fails 2 'output is required' chart
  fails 2 'side' chart -o c --side 8
  fails 1 'nothing is left.*--widths' chart -o c --knobs width
  fails 1 'absent' chart -o c --knobs width --widths absent
  fails 1 'fewer than two' chart -o c --knobs width --widths $S
  fails 1 'no_folder' chart -o no_folder/c --knobs radius]=])
app_test(chart_compares_depth_networks_of_several_widths "
  mkdir w
  cp $S/depth.safetensors w/depth-small.safetensors
  fails 1 'fewer than two' chart -o c --views 1 --side 64 --knobs width --widths w
  cp ${PROJECT_SOURCE_DIR}/data/weights/depth.safetensors w/depth-f16.safetensors
  works chart -o c --views 1 --side 64 --knobs width,image-size --widths w
  is \"$(grep '^width,' c/chart.csv | cut -d, -f2,3 | xargs)\" = 'small,0 f16,1'
  cp w/depth-f16.safetensors w/depth-again.safetensors
  fails 1 '2 networks are as wide' chart -o d --knobs width --widths w
  works chart -o d --views 1 --side 64 --knobs width,image-size
  says 'width is left out'")
app_test(chart_interrupted_leaves_nothing [=[
  env --default-signal=INT "$program" --threads 1 chart -o c --views 50 --side 256 --knobs radius 2>"$work/err" & pid=$!
  sleep 2
  find . | grep -q partial || complain "nothing was begun"
  kill -INT $pid
  wait $pid && complain "an interrupted run succeeded"
  says interrupted
  is "$(find .)" = .]=])
