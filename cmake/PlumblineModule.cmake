# Headers and templates that files share are compiled once for all of them: from nothing this takes less than half the
# time, after a change of one file more.
option(PLUMBLINE_UNITY "Compile a dozen files at once" OFF)

# Compiles the files of a target together, but for those named after it: what these define for themselves others do, too.
function(plumbline_compile_together target)
  if(PLUMBLINE_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
    set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

# plumbline_module(NAME geometry SOURCES a.cc ... [DEPS base ...] [PUBLIC lib ...] [PRIVATE lib ...] [ALONE a.cc ...]
#                  [QUICKLY])
# One folder, one library plumbline::<name>. DEPS are other modules; their order is checked by
# tools/check_layering.py. A module without sources is header only. ALONE: sources that are not
# compiled together with others. QUICKLY: for a module where a run spends less than a hundredth of
# its time; -O1 in place of -O3 takes a compiler a third to a half less.
function(plumbline_module)
  cmake_parse_arguments(ARG "QUICKLY" "NAME" "SOURCES;DEPS;PUBLIC;PRIVATE;ALONE" ${ARGN})
  set(target plumbline_${ARG_NAME})
  list(TRANSFORM ARG_DEPS PREPEND plumbline_)
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
    target_link_libraries(${target} PUBLIC plumbline_flags ${ARG_DEPS} ${ARG_PUBLIC}
                          PRIVATE $<BUILD_INTERFACE:plumbline_warnings> ${ARG_PRIVATE})
    plumbline_compile_together(${target} ${ARG_ALONE})
    if(ARG_QUICKLY)
      plumbline_use_precompiled(${target} plumbline_quick_module_headers)
      plumbline_optimize(${target} 1)
    else()
      plumbline_use_precompiled(${target} plumbline_module_headers)
    endif()
    if(OpenCV_INCLUDE_DIRS)
      target_include_directories(${target} SYSTEM PRIVATE ${OpenCV_INCLUDE_DIRS})
    endif()
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
    target_link_libraries(${target} INTERFACE plumbline_flags ${ARG_DEPS} ${ARG_PUBLIC})
  endif()
  add_library(plumbline::${ARG_NAME} ALIAS ${target})
endfunction()

# plumbline_page(REPORT_PAGE report_page.html a.css b.js ...)
# Sets the variable to the text of an HTML page that needs no other file: {{STYLE}} in it is replaced by all
# .css, {{SCRIPT}} by all other files, in the order given. CMake runs again when one of them changes.
function(plumbline_page variable page)
  set(style "")
  set(script "")
  foreach(name IN LISTS ARGN)
    file(READ ${name} content)
    if(name MATCHES "css$")
      string(APPEND style "${content}")
    else()
      string(APPEND script "${content}")
    endif()
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page} ${ARGN})
  file(READ ${page} text)
  string(REPLACE "{{STYLE}}" "${style}" text "${text}")
  string(REPLACE "{{SCRIPT}}" "${script}" text "${text}")
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

# plumbline_tests(NAME geometry SOURCES se3_test.cc ... [LIBS lib ...] [LABELS unit] [TIMEOUT 120]
#                 [REAL_DATA] [LONG] [ALONE se3_test.cc ...])
# One test executable for one module; every TEST() becomes a CTest test. REAL_DATA: it looks for the
# recorded sequences (tests/support/data_folder.h). LONG: the tests compute so much by themselves that
# they run several times as long where a compiler optimizes nothing. ALONE: as for modules.
function(plumbline_tests)
  cmake_parse_arguments(ARG "REAL_DATA;LONG" "NAME;TIMEOUT" "SOURCES;LIBS;LABELS;ALONE" ${ARGN})
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(PLUMBLINE_SANITIZE)
    math(EXPR ARG_TIMEOUT "5 * ${ARG_TIMEOUT}")  # all of it runs several times as long
  endif()
  set(target ${ARG_NAME}_test)
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_LIBS} plumbline_warnings GTest::gmock GTest::gtest_main)
  plumbline_compile_together(${target} ${ARG_ALONE})
  if(ARG_LONG)
    plumbline_use_precompiled(${target} plumbline_long_test_headers)
    plumbline_optimize(${target} 1)
    # GCC 12 sees too little at this level, and reports what is not so.
    target_compile_options(${target} PRIVATE
                           $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-mismatched-new-delete>)
  else()
    plumbline_use_precompiled(${target} plumbline_test_headers)
    plumbline_optimize(${target} 0)
  endif()
  if(ARG_REAL_DATA)
    target_compile_definitions(
      ${target} PRIVATE PLUMBLINE_DATA_BESIDE_SOURCE="${PROJECT_SOURCE_DIR}/../shared/data")
  endif()
  set(environment "")
  if(PLUMBLINE_SANITIZE MATCHES "address")
    set(environment ENVIRONMENT
        "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tools/leaks_of_others.txt:print_suppressions=0")
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${ARG_NAME}." DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT}
                                  ${environment})
endfunction()
