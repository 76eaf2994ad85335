// SPDX-License-Identifier: BSD-3-Clause
#include "apps/part.h"

#include <dlfcn.h>

#include "libps/core/error.h"

namespace ps::apps {

void* address_in_part(const std::string& part, const char* function) {
  const std::string name = "libpixelsynth_" + part + ".so";
  void* const library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);  // and never closed
  void* const address = library != nullptr ? dlsym(library, function) : nullptr;
  if (address == nullptr) throw Error(part, dlerror(), name + " of this version of the program");
  return address;
}

}  // namespace ps::apps
