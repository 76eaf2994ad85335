# SPDX-License-Identifier: BSD-3-Clause
# libtorch, for the trainer alone: its targets are left out where it is not installed, and under sanitizers, which
# would watch libtorch and little else.
set(PIXELSYNTH_TORCH OFF)
if(NOT PIXELSYNTH_SANITIZE)
  find_package(Torch QUIET)
  if(TORCH_FOUND)
    set(PIXELSYNTH_TORCH ON)
    # Its own compile options would reach every target; take its libraries and headers alone.
    add_library(pixelsynth_torch INTERFACE)
    target_include_directories(pixelsynth_torch SYSTEM INTERFACE ${TORCH_INCLUDE_DIRS})
    target_link_libraries(pixelsynth_torch INTERFACE ${TORCH_LIBRARIES})
  endif()
endif()
if(NOT PIXELSYNTH_TORCH)
  message(STATUS "without libtorch or under sanitizers: `train` is left out (libtorch-dev)")
endif()
