# SPDX-License-Identifier: BSD-3-Clause
app_test(eval_consistency_compares_the_strategies [=[
  works eval consistency $S/walk --frames 3:3 --directions left --samples 1 -o c.json
  writes c.json c.csv c.samples.csv
  prints 'method +PSNR, dB'
  prints '^support '
  prints '^independent '
  is "$(grep -c '^support,' c.samples.csv)" -eq 1
  works --json eval consistency $S/walk --frames 3:3 --directions left --samples 1 --methods support
  grep -q '"seam step"' "$work/out"]=])
app_test(eval_consistency_refuses_other_methods [=[
  fails 2 'methods.*best' eval consistency $S/walk --methods best
  fails 1 'absent' eval consistency absent]=])
