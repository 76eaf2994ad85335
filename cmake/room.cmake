# SPDX-License-Identifier: BSD-3-Clause
# pixelsynth_room(NAME [NOT_INSTALLED] SOURCES ... LINK ... PCH ...): one library for one room of DESIGN.md.
# Its target is pixelsynth_NAME, known to others as pixelsynth::NAME.

add_library(pixelsynth_flags INTERFACE)
target_compile_options(pixelsynth_flags INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor
  # One rounding for each operation, on every machine: results are the same bytes everywhere.
  -ffp-contract=off)
# Loading a library takes time, be it used or not.
target_link_options(pixelsynth_flags INTERFACE LINKER:--as-needed)
if(PIXELSYNTH_WERROR)
  target_compile_options(pixelsynth_flags INTERFACE -Werror)
endif()
if(PIXELSYNTH_SANITIZE)
  add_compile_options(-fsanitize=${PIXELSYNTH_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${PIXELSYNTH_SANITIZE})
  if(PIXELSYNTH_SANITIZE MATCHES undefined)
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()
if(PIXELSYNTH_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# PCL's own compile options would reach every target; take its libraries and headers alone.
add_library(pixelsynth_pcl INTERFACE)
target_include_directories(pixelsynth_pcl SYSTEM INTERFACE ${PCL_INCLUDE_DIRS})
target_link_libraries(pixelsynth_pcl INTERFACE pcl_common pcl_kdtree pcl_search)

function(pixelsynth_room name)
  cmake_parse_arguments(ROOM "NOT_INSTALLED" "" "SOURCES;LINK;PCH" ${ARGN})
  set(target pixelsynth_${name})
  add_library(${target} STATIC ${ROOM_SOURCES})
  add_library(pixelsynth::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/pixelsynth>)
  target_link_libraries(${target} PUBLIC ${ROOM_LINK} PRIVATE $<BUILD_INTERFACE:pixelsynth_flags>)
  if(ROOM_PCH)
    target_precompile_headers(${target} PRIVATE ${ROOM_PCH})
  endif()
  if(NOT ROOM_NOT_INSTALLED)
    set_property(GLOBAL APPEND PROPERTY PIXELSYNTH_ROOMS ${target})
  endif()
endfunction()

# pixelsynth_kernels(ROOM ISA SOURCES ... FLAGS ...): inner loops of a room for one instruction set, which they
# know as PS_ISA. One of these is picked at run time; the sources include C headers alone, so that no
# inline function can leak from one instruction set to another.
function(pixelsynth_kernels room isa)
  cmake_parse_arguments(KERNELS "" "" "SOURCES;FLAGS" ${ARGN})
  set(target ${room}_kernels_${isa})
  add_library(${target} OBJECT ${KERNELS_SOURCES})
  target_compile_features(${target} PRIVATE cxx_std_17)
  target_compile_definitions(${target} PRIVATE PS_ISA=${isa})
  target_compile_options(${target} PRIVATE -O3 -ffp-contract=off -fno-math-errno -Wno-psabi ${KERNELS_FLAGS})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE pixelsynth_flags)
  target_sources(pixelsynth_${room} PRIVATE $<TARGET_OBJECTS:${target}>)
endfunction()
