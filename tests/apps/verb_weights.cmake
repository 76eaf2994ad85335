# SPDX-License-Identifier: BSD-3-Clause
# weights info and weights convert. Checkpoints are the fuzzer's seeds, which Python's pickle wrote.
set(checkpoints ${PROJECT_SOURCE_DIR}/tests/fuzz/corpus/checkpoint)

app_test(weights_info_lists_tensors_and_counts_modules [=[
  works weights info $S/weights.safetensors
  prints '^vqvae.a.weight +F32 +\[2, 3\] +1 +1000 +169.2$'
  prints '^vqvae.a.count +I32 +\[\]$'
  prints '^fc.bias +F32 +\[2\] +-0.5 +0.5 +0$'
  prints '^vqvae +2 +6$'
  prints '^all +3 +8$'
  prints '^made_by: hand$'
  is ! -s "$work/err"]=])
app_test(weights_info_prints_json [=[
  works --json weights info $S/weights.safetensors
  is "$(json tensors "$work/out")" -eq 3
  is "$(json parameters "$work/out")" -eq 8
  prints '"name": "vqvae.a.weight"'
  prints '"greatest": 1000'
  prints '"made_by": "hand"'
  works -q weights info $S/weights.safetensors --json
  prints '"modules"']=])
app_test(weights_info_warns_of_values_that_are_not_finite [=[
  works weights info $S/bad_weights.safetensors
  says "warning: tensor 'fc.weight' holds NaN or infinity, 1 of 3"
  prints '^fc.weight .*not finite: 1$']=])
app_test(weights_convert_reads_both_containers "
  for f in zip_2 zip_deflated legacy_2 legacy_4; do
    works weights convert ${checkpoints}/$f -o $f.safetensors
    says '6 tensors, 15 parameters as f32'
    cmp $f.safetensors zip_2.safetensors
  done
  works weights info legacy_2.safetensors
  prints '^vqvae.a.weight_t +F32 +.3, 2. +0 +5 +2.5'
  prints '^vqvae.a.count +I64'
  prints '^netD.d +F32'")
app_test(weights_convert_stores_halves [=[
  works --json weights convert $S/weights.safetensors -o a.safetensors --type bf16
  grep -q '"type": "bf16"' "$work/out"
  works weights info a.safetensors
  prints '^vqvae.a.weight +BF16 +\[2, 3\] +1 +1000 '
  works weights convert $S/weights.safetensors -o a.safetensors --type f16
  works weights info a.safetensors
  prints '^vqvae.a.weight +F16 +\[2, 3\] +1 +1000 '
  prints '^vqvae.a.count +I32']=])
app_test(weights_convert_keeps_the_words_beside_the_tensors [=[
  works weights convert $S/weights.safetensors -o a.safetensors --type f16
  works weights info a.safetensors
  prints '^made_by: hand$']=])
app_test(weights_convert_says_whose_codes_a_pixelcnn_continues [=[
  cp -r $S/mixed w
  args="scene $S/photo.png --fov 60 --samples 1 --directions left --select likelihood --weights w"
  works weights convert $S/mixed/pixelcnn.safetensors -o w/pixelcnn.safetensors --codes w/vqvae.safetensors --type f16
  works $args -o s
  works weights convert $S/mixed/vqvae.safetensors -o w/vqvae.safetensors --type bf16
  works $args -o s
  mv w/other.safetensors w/vqvae.safetensors
  fails 1 'w/pixelcnn.safetensors: continues other codes than those of w/vqvae.safetensors.* trained together' -q $args -o t
  cp $S/mixed/pixelcnn.safetensors w/pixelcnn.safetensors
  works $args -o t
  fails 1 'quantize_t.embed' -q weights convert $S/mixed/pixelcnn.safetensors -o p.safetensors --codes w/refine.safetensors]=])
app_test(weights_convert_names_a_tensor_that_does_not_fit_its_type "
  fails 1 \"a.safetensors, tensor 'fc.weight': .*100000.* too large for f16\" -q weights convert $S/bad_weights.safetensors -o a.safetensors --type f16")
app_test(weights_convert_puts_a_prefix_before_names_without_a_network [=[
  works weights convert $S/weights.safetensors -o a.safetensors --prefix classifier
  works weights info a.safetensors
  prints '^classifier.fc.bias '
  prints '^vqvae.a.weight '
  fails 2 'prefix' weights convert $S/weights.safetensors -o b.safetensors --prefix 'a b']=])
app_test(weights_convert_never_replaces_what_it_reads [=[
  cp $S/weights.safetensors a.safetensors
  ln -s a.safetensors link.safetensors
  fails 1 'a.safetensors: is .*, which is read' weights convert a.safetensors -o a.safetensors
  fails 1 'link.safetensors: is .*, which is read' weights convert a.safetensors -o link.safetensors
  works weights info a.safetensors
  prints '^all +3 +8$']=])
app_test(weights_of_a_hostile_file_run_nothing [=[
  fails 1 "hostile.pth: .*REDUCE of 'os.system', at byte" weights info $S/hostile.pth
  fails 1 "hostile.pth: .*REDUCE of 'os.system', at byte" weights convert $S/hostile.pth -o a.safetensors
  is ! -e ran]=])
app_test(weights_that_are_unsound_fail_with_one_line [=[
  fails 1 'absent' weights info absent
  fails 1 'photo.png' weights info $S/photo.png
  fails 1 'nothing.jpg' weights info $S/nothing.jpg
  fails 1 'broken' weights info $S/broken.safetensors
  fails 1 "called 'vqvae.a.weight'" weights info $S/twice.safetensors
  fails 2 'a.pth: .*safetensors' weights convert $S/weights.safetensors -o a.pth
  fails 1 'no_folder' weights convert $S/weights.safetensors -o no_folder/a.safetensors
  fails 2 'type' weights convert $S/weights.safetensors -o a.safetensors --type f64
  fails 2 'required' weights convert $S/weights.safetensors]=])
