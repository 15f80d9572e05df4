# Warnings and code-generation rules, set per target.

# pliant_warnings(TARGET): the strict warnings, as errors.
function(pliant_warnings target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wcast-align -Wcast-qual
    -Wnon-virtual-dtor -Woverloaded-virtual -Wold-style-cast -Wnull-dereference -Wdouble-promotion
    -Wformat=2 -Wimplicit-fallthrough -Wundef)
  # Sanitizers make GCC warn of what cannot happen; every other build takes warnings as errors.
  if(NOT PLIANT_SANITIZE)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# pliant_deterministic(TARGET): the same arithmetic on every architecture. No contraction into fused
# multiply-add, no reassociation, no vectorised Eigen (its order of summation depends on the lane count).
# EIGEN_DONT_VECTORIZE is public because it is part of Eigen's ABI.
function(pliant_deterministic target)
  target_compile_options(${target} PRIVATE -ffp-contract=off -fno-math-errno)
  target_compile_definitions(${target} PUBLIC EIGEN_DONT_VECTORIZE)
endfunction()

# pliant_sanitizers: address;undefined or thread, for the whole build.
set(PLIANT_SANITIZE "" CACHE STRING "Sanitizers to build with, for example address,undefined")
if(PLIANT_SANITIZE)
  add_compile_options(-fsanitize=${PLIANT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PLIANT_SANITIZE})
endif()
