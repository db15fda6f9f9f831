# What almost every file includes is parsed once: for the modules, and with GoogleTest for the tests. A file
# still includes what it uses itself: the fuzz and tidy presets build without.
option(PLUMBLINE_PRECOMPILED_HEADERS "Parse the headers that most files include once" ON)

set(precompiled_headers
    <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <algorithm> <array> <cmath> <cstddef> <cstdint>
    <filesystem> <functional> <limits> <map> <memory> <numbers> <numeric> <optional> <set> <span> <sstream>
    <string> <string_view> <utility> <variant> <vector>)

# An object library with one empty file that owns a set of precompiled headers.
function(plumbline_precompile target position_independent libraries headers)
  set(empty ${CMAKE_CURRENT_BINARY_DIR}/${target}.cc)
  if(NOT EXISTS ${empty})
    file(WRITE ${empty} "")
  endif()
  add_library(${target} OBJECT ${empty})
  target_link_libraries(${target} PRIVATE plumbline_flags plumbline_warnings Eigen3::Eigen ${libraries})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ${position_independent})
  target_precompile_headers(${target} PRIVATE ${headers})
endfunction()

# The level of optimization of a target of a release build, where it is not that of CMake. Tests whose time is that of
# the modules have 0, which takes a compiler half the time of 1.
function(plumbline_optimize target level)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release,RelWithDebInfo>:-O${level}>)
endfunction()

# Each level of optimization has headers of its own: GCC 12 gives a file the level of the headers that it uses.
if(PLUMBLINE_PRECOMPILED_HEADERS)
  plumbline_precompile(plumbline_module_headers ON "" "${precompiled_headers}")
  plumbline_precompile(plumbline_quick_module_headers ON "" "${precompiled_headers}")
  plumbline_optimize(plumbline_quick_module_headers 1)
  if(PLUMBLINE_TESTS)
    set(test_headers "${precompiled_headers};<gmock/gmock.h>;<gtest/gtest.h>")
    plumbline_precompile(plumbline_test_headers OFF GTest::gmock "${test_headers}")
    plumbline_optimize(plumbline_test_headers 0)
    plumbline_precompile(plumbline_long_test_headers OFF GTest::gmock "${test_headers}")
    plumbline_optimize(plumbline_long_test_headers 1)
  endif()
endif()

# Gives a target the headers of `owner`; both are compiled with the same flags.
function(plumbline_use_precompiled target owner)
  if(PLUMBLINE_PRECOMPILED_HEADERS)
    get_target_property(position_independent ${owner} POSITION_INDEPENDENT_CODE)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ${position_independent})
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()
