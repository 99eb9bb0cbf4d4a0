# The installed package: find_package(pent) gives pent::format, pent::exchange, pent::contact,
# pent::simulator and pent::runs, the permissive part a host program links. The mesher and the viewer are installed as programs only.

include(CMakePackageConfigHelpers)
install(TARGETS pent_format pent_exchange pent_contact pent_simulator pent_runs EXPORT pentTargets FILE_SET HEADERS)
install(EXPORT pentTargets NAMESPACE pent:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pent)
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
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pent)
