# Debian packages by CPack: `cpack --config BUILD/CPackConfig.cmake -B DIR` makes one for each install
# component: plumbline (program), libplumbline-dev (dev) and, where they are built, python3-plumbline (python)
# and plumbline-ros2 (ros2). tools/test_packages.sh installs and uses them in a bare system.
set(packaging_dir ${PROJECT_SOURCE_DIR}/cmake/packages)
set(PLUMBLINE_PACKAGE_CONTACT "The Plumbline authors <plumbline@localhost>" CACHE STRING
    "Maintainer named in the Debian packages: name <address>")

# The Debian package that holds each CMake package which find_package(plumbline) looks for.
set(debian_package_Eigen3 "libeigen3-dev (>= 3.4)")
set(debian_package_OpenCV "libopencv-dev (>= 4.6)")
set(debian_package_SQLite3 "libsqlite3-dev")
set(debian_package_Threads "libc6-dev")
set(debian_package_embree "libembree-dev")
set(debian_package_fmt "libfmt-dev")
set(debian_package_nlohmann_json "nlohmann-json3-dev")
set(debian_package_yaml-cpp "libyaml-cpp-dev")
set(debian_package_zstd "libzstd-dev")

# What libplumbline-dev depends on: what plumbline-config.cmake looks for, libraries that are linked by
# name alone, and the package with the library that is loaded for videos.
function(plumbline_dev_dependencies result)
  set(packages "libbz2-dev" "libdeflate-dev" "liblz4-dev" "libspng-dev" "libturbojpeg0-dev" "libwebp-dev" "plumbline (= ${PROJECT_VERSION})")
  if(cutting_testbed IN_LIST PLUMBLINE_MODULES)
    list(APPEND packages "coinor-libipopt-dev" "libnlopt-cxx-dev")
  endif()
  file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/plumbline-config.cmake.in lines REGEX "^find_dependency\\(")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^find_dependency\\(([A-Za-z0-9_-]+).*" "\\1" name "${line}")
    if(NOT DEFINED debian_package_${name})
      message(FATAL_ERROR "plumbline-config.cmake looks for ${name}; cmake/Packages.cmake does not say which Debian package has it")
    endif()
    list(APPEND packages "${debian_package_${name}}")
  endforeach()
  list(SORT packages)
  list(JOIN packages ", " joined)
  set(${result} "${joined}" PARENT_SCOPE)
endfunction()

# Copyright and changelogs, as every Debian package has them.
function(plumbline_package_documents component package)
  install(FILES ${packaging_dir}/copyright ${CMAKE_CURRENT_BINARY_DIR}/packages/changelog.gz
                ${CMAKE_CURRENT_BINARY_DIR}/packages/CHANGELOG.md.gz
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package} COMPONENT ${component})
endfunction()

set(CPACK_PACKAGE_CONTACT "${PLUMBLINE_PACKAGE_CONTACT}")
# The time of the changelog, not of the build: the same source makes the same file.
file(TIMESTAMP ${PROJECT_SOURCE_DIR}/CHANGELOG.md changelog_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${packaging_dir}/changelog.in packages/changelog @ONLY)
configure_file(CHANGELOG.md packages/CHANGELOG.md COPYONLY)
configure_file(${packaging_dir}/plumbline.1.in packages/plumbline.1 @ONLY)
configure_file(${packaging_dir}/plumbline-ros2.1.in packages/plumbline-ros2.1 @ONLY)
foreach(file changelog CHANGELOG.md plumbline.1 plumbline-ros2.1)
  execute_process(COMMAND gzip -9 --no-name --force --keep ${CMAKE_CURRENT_BINARY_DIR}/packages/${file}
                  COMMAND_ERROR_IS_FATAL ANY)
endforeach()
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/packages/plumbline.1.gz
        DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)

# CMake strips programs, not static libraries.
install(CODE "
if(CMAKE_INSTALL_DO_STRIP)
  file(GLOB archives \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libplumbline_*.a\")
  execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-debug --remove-section=.comment --remove-section=.note
                          --enable-deterministic-archives \${archives} COMMAND_ERROR_IS_FATAL ANY)
endif()" COMPONENT dev)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_COMPONENTS_ALL program dev)
plumbline_package_documents(program plumbline)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME plumbline)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "gstreamer1.0-plugins-base, gstreamer1.0-plugins-good")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
"visual SLAM with points and straight lines
Plumbline computes where a camera went and what it saw, from the images of
one camera, a stereo pair or a camera with depth (RGB-D). It maps points and
straight lines, closes loops, and gives the same bytes for the same input.
.
This package has the program.")

plumbline_package_documents(dev libplumbline-dev)
plumbline_dev_dependencies(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libplumbline-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION
"visual SLAM with points and straight lines - library
Plumbline computes where a camera went and what it saw, from the images of
one camera, a stereo pair or a camera with depth (RGB-D).
.
This package has the headers, the static libraries and the CMake package
that find_package(plumbline) finds.")

get_cmake_property(components COMPONENTS)
if(python IN_LIST components)
  list(APPEND CPACK_COMPONENTS_ALL python)
  plumbline_package_documents(python python3-plumbline)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-plumbline)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The module is made for one version of the interpreter.
  math(EXPR next_python_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_python_minor}), python3-numpy, plumbline (= ${PROJECT_VERSION})")
  # Byte code is written when the package is installed and goes with it.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
      ${PROJECT_SOURCE_DIR}/cmake/packages/python3-plumbline/postinst
      ${PROJECT_SOURCE_DIR}/cmake/packages/python3-plumbline/prerm)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION
"visual SLAM with points and straight lines - Python module
Plumbline computes where a camera went and what it saw, from the images of
one camera, a stereo pair or a camera with depth (RGB-D).
.
This package has the module for Python 3.")
endif()
if(TARGET plumbline-ros2)
  list(APPEND CPACK_COMPONENTS_ALL ros2)
  plumbline_package_documents(ros2 plumbline-ros2)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/packages/plumbline-ros2.1.gz
          DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ros2)
  set(CPACK_DEBIAN_ROS2_PACKAGE_NAME plumbline-ros2)
  set(CPACK_DEBIAN_ROS2_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_ROS2_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_ROS2_DESCRIPTION
"visual SLAM with points and straight lines - node of ROS 2
Plumbline computes where a camera went and what it saw, from the images of
one camera, a stereo pair or a camera with depth (RGB-D).
.
This package has a program that takes the images from topics of ROS 2 and
publishes poses and the map. It speaks DDS and needs no installed ROS.")
endif()
include(CPack)
