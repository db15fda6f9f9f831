# `cmake --install BUILD --prefix DIR`: the program, the static libraries, their headers, and the package
# that find_package(plumbline) finds. Targets keep their names: plumbline::slam, plumbline::io, ...;
# plumbline::plumbline is all of them. Components, which become Debian packages: program, dev.
include(CMakePackageConfigHelpers)
include(PublicHeaders)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/plumbline)

add_library(plumbline_all INTERFACE)
set_target_properties(plumbline_all PROPERTIES EXPORT_NAME plumbline)
foreach(module IN LISTS PLUMBLINE_MODULES)
  set_target_properties(plumbline_${module} PROPERTIES EXPORT_NAME ${module})
  target_link_libraries(plumbline_all INTERFACE plumbline_${module})
endforeach()
set(targets ${PLUMBLINE_MODULES})
list(TRANSFORM targets PREPEND plumbline_)
install(TARGETS plumbline_flags plumbline_all ${targets} EXPORT plumbline_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS plumbline RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(EXPORT plumbline_targets NAMESPACE plumbline:: DESTINATION ${package_dir} COMPONENT dev)

# Headers need Eigen alone (tests: package.PublicHeadersNeedEigenAlone).
plumbline_public_headers(public_headers)
foreach(header IN LISTS public_headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} COMPONENT dev)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/generated/plumbline/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/plumbline COMPONENT dev)

configure_package_config_file(cmake/plumbline-config.cmake.in plumbline-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(plumbline-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/plumbline-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/plumbline-config-version.cmake
        DESTINATION ${package_dir} COMPONENT dev)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
# In no component, since a Debian package names the licence in its own way.
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
