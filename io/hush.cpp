// SPDX-License-Identifier: BSD-3-Clause
#include "io/hush.h"

#include <cstdio>
#include <iostream>
#include <mutex>

namespace ps {
namespace {

/// How many of them live, and what they have put aside. The C library's `stderr` is a
/// variable that may be set, as its manual says of redirecting a standard stream.
struct Silence {
  std::mutex mutex;
  std::FILE* nowhere = nullptr;  ///< null until hush_decoders()
  std::FILE* c_stream = nullptr;
  std::streambuf* cpp_stream = nullptr;
  int count = 0;
};

Silence& silence() {
  static auto* one = new Silence;  // decoders may run while statics are destroyed
  return *one;
}

}  // namespace

void hush_decoders() {
  const std::lock_guard<std::mutex> lock(silence().mutex);
  if (silence().nowhere == nullptr) silence().nowhere = std::fopen("/dev/null", "we");
}

Hush::Hush() {
  Silence& s = silence();
  const std::lock_guard<std::mutex> lock(s.mutex);
  counts_ = s.nowhere != nullptr;
  if (!counts_ || s.count++ > 0) return;
  s.c_stream = stderr;
  stderr = s.nowhere;
  s.cpp_stream = std::cerr.rdbuf(nullptr);
}

Hush::~Hush() {
  Silence& s = silence();
  const std::lock_guard<std::mutex> lock(s.mutex);
  if (!counts_ || --s.count > 0) return;
  stderr = s.c_stream;
  std::cerr.rdbuf(s.cpp_stream);
}

}  // namespace ps
