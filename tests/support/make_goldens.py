#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""make_goldens.py REFERENCE DATA PROGRAM: makes DATA/golden/{weights,networks}.safetensors anew.

REFERENCE holds what the PixelSynth authors' own code computed (MANIFEST.txt there). Of its weights
these are kept: what the networks read, of the discriminator the second scale, and of the PixelCNN's
codes those that the case uses. Of its results a few pixels are kept, and of its pictures a corner,
which is enough for all networks but two. Those see the whole picture at once: PROGRAM (pixelsynth)
computes their results of a picture of formulas, once it has been found to give the reference's on
the reference's pictures. Needs the standard library alone.
"""
import array
import json
import re
import struct
import subprocess
import sys
import tempfile

CODES = {"F32": "f", "I32": "i", "U8": "B"}
WIDTHS = {"F32": 4, "F16": 2, "I32": 4, "U8": 1}
PHOTO = "606"
SIDE = 256
CUT = 96    # side of the photo's corner
SEEN = 52   # side of the corner of the refiner's output that does not see the cut
CELLS = 5   # the same of the autoencoder's grid
AGREES = 1e-5  # of the largest value


class Tensor:
    """Values in row-major order."""

    def __init__(self, dtype, shape, values):
        self.dtype, self.shape, self.values = dtype, list(shape), values

    def bytes(self):
        if self.dtype == "F16":
            return struct.pack("<%de" % len(self.values), *self.values)
        return array.array(CODES[self.dtype], self.values).tobytes()

    def planes(self, rows, columns):
        """These rows and columns of a tensor [..., height, width]."""
        height, width = self.shape[-2:]
        planes = len(self.values) // (height * width)
        picked = [self.values[(p * height + y) * width + x]
                  for p in range(planes) for y in rows for x in columns]
        return Tensor(self.dtype, self.shape[:-2] + [len(rows), len(columns)], picked)

    def every(self, step):
        height, width = self.shape[-2:]
        return self.planes(range(0, height, step), range(0, width, step))

    def take(self, axis, indices):
        inner = 1
        for side in self.shape[axis + 1:]:
            inner *= side
        outer = len(self.values) // (inner * self.shape[axis])
        picked = []
        for o in range(outer):
            for i in indices:
                begin = (o * self.shape[axis] + i) * inner
                picked.extend(self.values[begin:begin + inner])
        shape = list(self.shape)
        shape[axis] = len(indices)
        return Tensor(self.dtype, shape, picked)


def read(path):
    with open(path, "rb") as file:
        content = file.read()
    begin = 8 + struct.unpack("<Q", content[:8])[0]
    tensors = {}
    for name, entry in json.loads(content[8:begin]).items():
        if name == "__metadata__":
            continue
        first, last = entry["data_offsets"]
        data = content[begin + first:begin + last]
        if entry["dtype"] == "F16":
            values = struct.unpack("<%de" % (len(data) // 2), data)
        else:
            values = array.array(CODES[entry["dtype"]], data)
        tensors[name] = Tensor(entry["dtype"], entry["shape"], values)
    return tensors


def write(path, tensors):
    header, data = {}, b""
    for name in sorted(tensors, key=lambda n: (-WIDTHS[tensors[n].dtype], n)):
        tensor, begin = tensors[name], len(data)
        data += tensor.bytes()
        header[name] = {"dtype": tensor.dtype, "shape": tensor.shape,
                        "data_offsets": [begin, len(data)]}
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)


def used_codes(cnn, greedy):
    """The codes of the PixelCNN's case R and of its greedy completion."""
    return sorted(set(cnn["R.codes"].values) | set(greedy["codes_out"].values) |
                  set(greedy["codes_in"].values))


def kept_weights(weights, codes):
    kept = {}
    for name, tensor in weights.items():
        name = re.sub(r"^model\.module\.", "", name).replace("netD.netD.netD.", "netD.")
        unused = ("pts_transformer.", "vqvae.dec_t.", "vqvae.quantize_b.", "vqvae.quantize_conv_b.",
                  "vqvae.quantize_t.cluster_size", "vqvae.quantize_t.embed_avg",
                  "netD.discriminator_0.")
        counter = "num_batches" in name or "accumulation" in name
        if name.startswith(unused) or counter or "." not in name:
            continue
        if name == "outpaint2.u_init.weight":
            tensor = tensor.take(1, codes + [tensor.shape[1] - 1])
        if name.startswith("outpaint2.nin_out."):
            tensor = tensor.take(0, codes)
        # Half the bytes of the layers that see little but their own depth: 1e-5 of the result.
        if re.fullmatch(r"pts_regressor\.(conv[5-8]|dconv[1-4])\.weight_orig", name):
            tensor = Tensor("F16", tensor.shape, tensor.values)
        kept[name] = tensor
    return kept


def corner_of(tensor, side):
    height, width = tensor.shape[-2:]
    return tensor.planes(range(height - side, height), range(width - side, width))


def kept_results(folder, codes):
    vq, order = read(folder + "/b_vqvae.safetensors"), read(folder + "/c_order.safetensors")
    cnn, refine = read(folder + "/d_pixelcnn.safetensors"), read(folder + "/f_refine.safetensors")
    number = {code: i for i, code in enumerate(codes)}
    corner = corner_of(refine["case2.input"], CUT)  # of the same photo
    gap = corner_of(vq[PHOTO + ".gap"], CELLS).values
    kept = {
        "corner": Tensor("U8", corner.shape, [round((v + 1) * 127.5) for v in corner.values]),
        "vq.pre_quant": corner_of(vq[PHOTO + ".pre_quant"], CELLS),
        "vq.nearest": corner_of(vq[PHOTO + ".codes"], CELLS),
        "vq.clear": Tensor("U8", [CELLS, CELLS], [int(g > 1e-3) for g in gap]),
        "vq.codes": vq[PHOTO + ".codes"],
        "vq.decoded": vq[PHOTO + ".decoded"].every(7),
        "pixelcnn.codes": Tensor("I32", [1, 32, 32], [number[c] for c in cnn["R.codes"].values]),
        "pixelcnn.missing": cnn["R.missing"],
        "pixelcnn.logits_full": cnn["R.logits_full"].take(1, codes).every(16),
        "pixelcnn.logits_masked": cnn["R.logits_masked"].take(1, codes).every(8),
        "refine.bg_dilated": corner_of(refine["case2.bg_dilated"], CUT),
        "refine.noise": refine["case2.noise"],
        "refine.output": corner_of(refine["case2.output"], SEEN),
    }
    for mask in ("mask_init", "mask_undilated", "mask_dilated"):
        kept["pixelcnn." + mask] = order["R." + mask]
    kept.update(kept_completion(read(folder + "/h_greedy.safetensors"), codes))
    kept["order.bg256"] = packed(order["island.bg256"])
    for name in ("order", "distance32", "missing32"):
        kept["order." + name] = order["island." + name]
    return kept


def packed(mask):
    """Eight pixels of a row in a byte, the first in its lowest bit."""
    bits = mask.values
    return Tensor("U8", mask.shape[:-1] + [mask.shape[-1] // 8],
                  [sum((bits[i + k] != 0) << k for k in range(8)) for i in range(0, len(bits), 8)])


def kept_completion(greedy, codes):
    """The greedy completion, and the logits of every 45th of its 450 steps."""
    number = {code: i for i, code in enumerate(codes)}
    kept = {"greedy." + name: Tensor("I32", greedy[name].shape, [number[c] for c in greedy[name].values])
            for name in ("codes_in", "codes_out")}
    kept["greedy.order"], kept["greedy.missing32"] = greedy["order"], greedy["missing32"]
    steps = range(0, greedy["tokens"].shape[0], 45)
    kept["greedy.steps"] = greedy["tokens"].take(0, steps).take(1, [0, 1])
    kept["greedy.step_logits"] = greedy["step_logits"].take(0, steps).take(1, codes)
    return kept


def probe(program, module, weights, tensors):
    with tempfile.TemporaryDirectory() as here:
        write(here + "/in.safetensors", tensors)
        subprocess.run([program, "-q", "probe", module, "--weights", weights, "--in",
                        here + "/in.safetensors", "--out", here + "/out.safetensors"], check=True)
        return read(here + "/out.safetensors")


def must_agree(what, got, expected):
    largest = max(abs(v) for v in expected.values)
    worst = max(abs(a - b) for a, b in zip(got.values, expected.values)) / largest
    print("%s: off by %.1e of the largest value" % (what, worst))
    if got.shape != expected.shape or not worst <= AGREES:
        sys.exit(what + " is not the reference's")


def picture():
    """Of formulas: the same as golden_picture() in tests/models/support.cpp."""
    values = [(2 * x + 3 * y * (c + 1) + 50 * ((x // 24 + y // 40) % 3)) % 256
              for c in range(3) for y in range(SIDE) for x in range(SIDE)]
    return Tensor("F32", [1, 3, SIDE, SIDE], array.array("f", [v / 127.5 - 1 for v in values]))


def computed_results(folder, program, golden_weights):
    weights = folder + "/weights.safetensors"
    depth, disc = read(folder + "/a_unet.safetensors"), read(folder + "/g_disc.safetensors")
    for photo in ("1011", "606"):
        raw = probe(program, "depth", weights, {"input": depth["input_" + photo]})["raw"]
        must_agree("depth of " + photo, raw, depth["raw_" + photo])
    for i, image in enumerate(("fake", "real")):
        found = probe(program, "discriminator", weights, {"fake": disc[image]})
        for scale in ("scale0.layer4", "scale1.layer4"):
            must_agree(image + " " + scale, found[scale], disc[scale].take(0, [i]))
    with tempfile.TemporaryDirectory() as here:
        both = read(golden_weights)
        for name in [n for n in both if n.startswith("netD.discriminator_1.")]:
            both[name.replace("_1.", "_0.", 1)] = both[name]
        write(here + "/both.safetensors", both)
        raw = probe(program, "depth", golden_weights, {"input": picture()})["raw"]
        found = probe(program, "discriminator", here + "/both.safetensors", {"fake": picture()})
    return {"depth.raw": raw.every(5), "discriminator.scale1": found["scale1.layer4"]}


def main():
    folder, golden, program = sys.argv[1], sys.argv[2] + "/golden", sys.argv[3]
    cnn, greedy = read(folder + "/d_pixelcnn.safetensors"), read(folder + "/h_greedy.safetensors")
    codes = used_codes(cnn, greedy)
    weights = read(folder + "/weights.safetensors")
    write(golden + "/weights.safetensors", kept_weights(weights, codes))
    results = kept_results(folder, codes)
    results.update(computed_results(folder, program, golden + "/weights.safetensors"))
    write(golden + "/networks.safetensors", results)


if __name__ == "__main__":
    main()
