#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""make_checkpoints.py DIR: writes the seeds of corpus/checkpoint.

They have the layout of torch.save's containers, but Python's own pickle and zipfile write them:
torch is not needed, and the reader meets another writer than tests/io/checkpoint_maker.h.
"""
import argparse
import collections
import io
import pathlib
import pickle
import struct
import sys
import types
import zipfile

MAGIC = 0x1950A86A20F9469CFC6C
CODES = {"Float": "f", "Half": "e", "Double": "d", "Long": "q", "Bool": "?"}


def module(name, **members):
    made = types.ModuleType(name)
    for key, member in members.items():
        member.__module__, member.__qualname__ = name, key
        setattr(made, key, member)
    sys.modules[name] = made
    return made


torch = module("torch", **{kind + "Storage": type(kind + "Storage", (), {}) for kind in CODES})
utils = module("torch._utils", _rebuild_tensor_v2=lambda *a: None,
               _rebuild_parameter=lambda *a: None)


class Storage:
    def __init__(self, key, kind, values):
        self.key, self.kind, self.count = key, kind, len(values)
        self.bytes = struct.pack("<%d%s" % (len(values), CODES[kind]), *values)


class Tensor:
    def __init__(self, storage, offset, shape, strides, parameter=False):
        self.storage, self.parameter = storage, parameter
        self.view = (offset, shape, strides, parameter, collections.OrderedDict())

    def __reduce_ex__(self, protocol):
        if self.parameter:
            plain = Tensor(self.storage, *self.view[:3])
            return utils._rebuild_parameter, (plain, True, collections.OrderedDict())
        return utils._rebuild_tensor_v2, (self.storage, *self.view)


class Pickler(pickle.Pickler):
    def __init__(self, file, protocol, legacy):
        super().__init__(file, protocol)
        self.legacy = legacy

    def persistent_id(self, value):
        if not isinstance(value, Storage):
            return None
        id = ("storage", getattr(torch, value.kind + "Storage"), value.key, "cpu", value.count)
        return id + (None,) if self.legacy else id


def pickled(value, protocol, legacy=False):
    file = io.BytesIO()
    Pickler(file, protocol, legacy).dump(value)
    return file.getvalue()


def zipped(value, storages, protocol=2, how=zipfile.ZIP_STORED):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", how) as archive:
        archive.writestr(zipfile.ZipInfo("w/data.pkl"), pickled(value, protocol), how)
        archive.writestr(zipfile.ZipInfo("w/byteorder"), "little", how)
        for storage in storages:
            archive.writestr(zipfile.ZipInfo("w/data/" + storage.key), storage.bytes, how)
        archive.writestr(zipfile.ZipInfo("w/version"), "3\n", how)
    return file.getvalue()


def legacy(value, storages, protocol=2):
    system = dict(protocol_version=1001, little_endian=True,
                  type_sizes=dict(short=2, int=4, long=4))
    pickles = [MAGIC, 1001, system, value, [s.key for s in storages]]
    parts = [pickled(p, protocol, legacy=True) for p in pickles]
    return b"".join(parts + [struct.pack("<q", s.count) + s.bytes for s in storages])


def main(folder):
    storages = [Storage("0", "Float", [0, 1, 2, 3, 4, 5]), Storage("1", "Half", [0.5, -0.5]),
                Storage("2", "Long", [7]), Storage("3", "Double", [0.25]),
                Storage("4", "Bool", [True])]
    f, h, n, d, b = storages
    state = collections.OrderedDict()
    state["model.module.vqvae.a.weight"] = Tensor(f, 0, (2, 3), (3, 1))
    state["model.module.vqvae.a.weight_t"] = Tensor(f, 0, (3, 2), (1, 3))
    state["model.module.vqvae.a.bias"] = Tensor(h, 0, (2,), (1,), parameter=True)
    state["model.module.vqvae.a.count"] = Tensor(n, 0, (), ())
    state["netD.netD.d"] = Tensor(d, 0, (1,), (1,))
    state["flag"] = Tensor(b, 0, (1,), (1,))
    state._metadata = collections.OrderedDict([("", {"version": 1})])
    options = argparse.Namespace(W=256, losses=["1.0_l1"], rate=1e-4, names={1, 2}, raw=b"bytes",
                                 folder=pathlib.PurePosixPath("/a"), large=1 << 80)
    whole = {"state_dict": state, "epoch": 150, "opts": options}
    nested = {"net": {"layers": [state["flag"], (Tensor(f, 4, (2, 2), (1, 0)), None)]}}
    seeds = {"zip_2": zipped(whole, storages), "zip_4": zipped(whole, storages, 4),
             "zip_deflated": zipped(whole, storages, 3, zipfile.ZIP_DEFLATED),
             "zip_nested": zipped(nested, [f, b]),
             "legacy_2": legacy(whole, storages), "legacy_3": legacy(nested, [f, b], 3),
             "legacy_4": legacy(whole, storages, 4), "legacy_5": legacy(nested, [f, b], 5)}
    for name, content in seeds.items():
        (pathlib.Path(folder) / name).write_bytes(content)


main(sys.argv[1])
