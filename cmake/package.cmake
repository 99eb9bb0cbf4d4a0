# The installed package: find_package(pent) gives pent::format, pent::exchange, pent::contact, pent::simulator and
# pent::runs, the permissive part a host program links, and pent::plugin, the shared library for hosts in C. The mesher
# and the viewer are installed as programs only.

include(CMakePackageConfigHelpers)
install(TARGETS pent_format pent_exchange pent_contact pent_simulator pent_runs EXPORT pentTargets
  ARCHIVE COMPONENT development FILE_SET HEADERS COMPONENT development)
install(EXPORT pentTargets NAMESPACE pent:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pent COMPONENT development)
write_basic_package_version_file(pentConfigVersion.cmake COMPATIBILITY SameMinorVersion)
if(PENT_THREADS STREQUAL tbb)
  set(pent_find_threads "find_dependency(TBB)\n")
endif()
file(WRITE ${PROJECT_BINARY_DIR}/pentConfig.cmake
  "include(CMakeFindDependencyMacro)\n"
  "find_dependency(Eigen3 3.4)\n"
  "find_dependency(Threads)\n"
  "${pent_find_threads}"
  "include(\${CMAKE_CURRENT_LIST_DIR}/pentTargets.cmake)\n")
install(FILES ${PROJECT_BINARY_DIR}/pentConfig.cmake ${PROJECT_BINARY_DIR}/pentConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pent COMPONENT development)
if(NOT PROJECT_IS_TOP_LEVEL)  # hosts that build us among their own install and pack what they want
  return()
endif()

# What comes along: scenes and models of our own to try, and what is to be said of licences.
install(DIRECTORY data/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/pentimento FILES_MATCHING PATTERN "*.toml")
install(FILES data/models/alien_4006f.obj data/models/octopus_5246f.obj
  DESTINATION ${CMAKE_INSTALL_DATADIR}/pentimento/models)
install(PROGRAMS scripts/study_slurm.sh DESTINATION ${CMAKE_INSTALL_DATADIR}/pentimento/scripts)
install(FILES cmake/packages/copyright LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(PENT_BUILD_MESHER)
  install(FILES mesher/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.pent-mesh)
  install(FILES mesher/tetgen_worker/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.pent-tetgen)
endif()

# Packages, see scripts/package.sh: an archive of everything that works in any folder, and for Debian the programs
# with the library to load, and apart from them what is linked.
set(CPACK_PACKAGE_NAME pentimento)
set(CPACK_PACKAGE_VENDOR "The Pentimento authors")
# Who makes a package answers for it. By default nobody: a name that can never be anybody's (RFC 2606).
set(PENT_PACKAGE_CONTACT "Nobody in particular <nobody@pentimento.invalid>" CACHE STRING
  "Maintainer of the Debian packages: NAME <ADDRESS>")
if(NOT PENT_PACKAGE_CONTACT MATCHES "^[^<>]+ <[^<> ]+@[^<> ]+>$")
  message(FATAL_ERROR "PENT_PACKAGE_CONTACT is \"${PENT_PACKAGE_CONTACT}\"; expected NAME <ADDRESS>")
endif()
set(CPACK_PACKAGE_CONTACT "${PENT_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "meshes and simulates deformable bodies of four dimensions")
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR TGZ DEB)
set(CPACK_PACKAGE_FILE_NAME pentimento-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME pentimento)
set(pent_debian ${PROJECT_BINARY_DIR}/packages)
get_target_property(pent_soversion pent_plugin SOVERSION)
file(WRITE ${pent_debian}/shlibs "libpent_plugin ${pent_soversion} pentimento (>= ${PROJECT_VERSION})\n")
file(WRITE ${pent_debian}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA ${pent_debian}/shlibs ${pent_debian}/triggers)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS fonts-dejavu-core)  # of captions
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS ffmpeg)          # makes movies
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION
"Makes pentachoral meshes (the four-dimensional counterpart of tetrahedral
ones) of surfaces and shapes, simulates them as elastic bodies, and shows
three-dimensional slices of what happens as surfaces, pictures, movies
and in the browser. With a library that hosts load for its C interface.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME pentimento-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
# Debian wants its own form of a list of changes; ours is CHANGELOG.md beside it.
string(TIMESTAMP pent_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${pent_debian}/changelog
  "pentimento (${PROJECT_VERSION}) stable; urgency=medium\n\n  * See CHANGELOG.md.\n\n"
  " -- ${CPACK_PACKAGE_CONTACT}  ${pent_date}\n")
execute_process(COMMAND gzip -9nf ${pent_debian}/changelog)
install(FILES ${pent_debian}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${pent_debian}/changelog.gz cmake/packages/copyright
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/pentimento-dev COMPONENT development)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "pentimento (= ${PROJECT_VERSION}), libeigen3-dev")
if(PENT_THREADS STREQUAL tbb)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libtbb-dev")
endif()
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"Headers, static libraries and the CMake package of the simulator, of scene
files and of meshes, and the header of the C interface.")
include(CPack)
