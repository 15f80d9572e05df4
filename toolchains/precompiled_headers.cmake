# With PLIANT_PRECOMPILE the headers of others, in which a build from nothing spends most of its time, are read once
# and not once a file. Without use beside a compiler cache, and for programs that read the compile commands.
option(PLIANT_PRECOMPILE "Read the headers of other libraries once: for builds from nothing" OFF)

set(precompiled_everywhere <algorithm> <array> <cmath> <cstdint> <cstdlib> <cstring> <limits> <span> <utility>
  <Eigen/Core> <Eigen/Geometry> <Eigen/Cholesky> <Eigen/LU>)
set(precompiled_outside_core <atomic> <filesystem> <functional> <memory> <mutex> <optional> <string> <string_view> <thread> <vector>
  <fmt/format.h>)

# pliant_precompiled_pot(NAME [PROGRAM|DETERMINISTIC] [LIBRARIES ...] [HEADERS ...]): what targets of one kind take
# theirs from. Libraries and programs differ by their position-independent code, deterministic ones by a macro.
function(pliant_precompiled_pot name)
  cmake_parse_arguments(ARG "PROGRAM;DETERMINISTIC" "" "LIBRARIES;HEADERS" ${ARGN})
  file(WRITE ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp "int main() { return 0; }\n")
  if(ARG_PROGRAM)
    add_executable(${name} EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp)
  else()
    add_library(${name} OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp)
  endif()
  pliant_warnings(${name})
  target_link_libraries(${name} PRIVATE Eigen3::Eigen fmt::fmt ${ARG_LIBRARIES})
  target_compile_definitions(${name} PRIVATE EIGEN_DONT_VECTORIZE)
  if(ARG_DETERMINISTIC)
    pliant_deterministic(${name})
  endif()
  target_precompile_headers(${name} PRIVATE ${precompiled_everywhere} ${precompiled_outside_core} ${ARG_HEADERS})
endfunction()

# All targets of a folder and of those below it.
function(pliant_targets_below folder result)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(below IN LISTS folders)
    pliant_targets_below(${below} more)
    list(APPEND targets ${more})
  endforeach()
  set(${result} ${targets} PARENT_SCOPE)
endfunction()

# pliant_precompile_headers(): called when all targets are known.
function(pliant_precompile_headers)
  if(NOT PLIANT_PRECOMPILE)
    return()
  endif()
  pliant_targets_below(${PROJECT_SOURCE_DIR} targets)
  # Files with instruction sets of their own cannot use what was read for another.
  get_target_property(sources pliant_core SOURCES)
  foreach(source IN LISTS sources)
    get_source_file_property(own ${source} TARGET_DIRECTORY pliant_core COMPILE_OPTIONS)
    if(own)
      set_source_files_properties(${source} TARGET_DIRECTORY pliant_core PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
  target_precompile_headers(pliant_core PRIVATE ${precompiled_everywhere})

  find_package(fmt REQUIRED)
  if(PLIANT_BUILD_TESTS)
    find_package(GTest REQUIRED)
  endif()
  pliant_precompiled_pot(pliant_library_headers)
  pliant_precompiled_pot(pliant_deterministic_headers DETERMINISTIC)
  pliant_precompiled_pot(pliant_program_headers PROGRAM)
  if(TARGET GTest::gtest)
    pliant_precompiled_pot(pliant_test_headers PROGRAM LIBRARIES GTest::gtest HEADERS <gtest/gtest.h>)
  endif()
  list(REMOVE_ITEM targets pliant_core)
  foreach(target IN LISTS targets)
    # What shares Eigen's types with PCL must lay them out as PCL does, for vectors.
    get_target_property(folder ${target} SOURCE_DIR)
    if(folder STREQUAL "${PROJECT_SOURCE_DIR}/tests/peer")
      continue()
    endif()
    get_target_property(type ${target} TYPE)
    get_target_property(libraries ${target} LINK_LIBRARIES)
    get_target_property(options ${target} COMPILE_OPTIONS)
    if(type STREQUAL STATIC_LIBRARY AND "-fno-math-errno" IN_LIST options)
      set(pot pliant_deterministic_headers)
    elseif(type STREQUAL STATIC_LIBRARY)
      set(pot pliant_library_headers)
    elseif(NOT type STREQUAL EXECUTABLE)
      continue()
    elseif(GTest::gtest IN_LIST libraries)
      set(pot pliant_test_headers)
    else()
      set(pot pliant_program_headers)
    endif()
    # GCC no longer knows that what it inlines out of them is another's, and warns of it.
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-error=array-bounds;-Wno-error=stringop-overread>)
    # What the headers ask for must be the same as where they were read.
    target_compile_definitions(${target} PRIVATE EIGEN_DONT_VECTORIZE FMT_SHARED)
    target_precompile_headers(${target} REUSE_FROM ${pot})
  endforeach()
endfunction()
