# Flags and functions shared by all our targets.

# What was compiled before, in this folder or in another clone of the project, comes from the store of ccache. Paths are taken
# from the project's folder for that; counts of lines that ran need whole ones.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER AND NOT PENT_COVERAGE AND NOT EMSCRIPTEN)
  find_program(PENT_CCACHE ccache)
  if(PENT_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      ${PENT_CCACHE})
    set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
  endif()
endif()

# Files of wider instruction sets, which are chosen at run time.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(PENT_X86 ON)
  set(PENT_AVX2 -mavx2 -mfma)
  set(PENT_AVX512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma)
endif()

# Libraries that are headers alone are those of this machine, behind the headers of emscripten: before them,
# the C library would be this machine's, too.
set(PENT_POSITION_INDEPENDENT ON)  # for the shared library of plugin
if(EMSCRIPTEN)
  set(PENT_POSITION_INDEPENDENT OFF)
  list(APPEND CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES /usr/include)
  add_compile_options(-idirafter /usr/include -w)  # warnings are the business of compilers for 64 bits
endif()

add_library(pent_build_flags INTERFACE)  # our own code only; not seen by users of the package
target_compile_options(pent_build_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast -Wnon-virtual-dtor -Wdouble-promotion>
  # g++ 12 finds overlaps in string sums, and unset members of Boost's and Eigen's, that are not there.
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict$<SEMICOLON>-Wno-maybe-uninitialized>
  -ffp-contract=off  # same digits with and without FMA hardware
  $<$<BOOL:${PENT_WERROR}>:-Werror>)
if(PENT_SANITIZE)
  # A finding ends the program. Left out: what the address sanitizer finds as well, and what doubles
  # the time and the memory that heavy templates take to compile.
  target_compile_options(pent_build_flags INTERFACE
    -fsanitize=${PENT_SANITIZE} -fno-sanitize=null,alignment,object-size,vptr
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(pent_build_flags INTERFACE -fsanitize=${PENT_SANITIZE})
endif()
if(PENT_COVERAGE)
  # Threads count too, so updates are atomic; headers of others are not counted.
  target_compile_options(pent_build_flags INTERFACE
    --coverage -fprofile-update=atomic -fprofile-exclude-files=/usr/include/.*)
  target_link_options(pent_build_flags INTERFACE --coverage -Wl,--wrap=_exit,--wrap=_Exit)
  add_library(pent_count_at_exit STATIC ${CMAKE_CURRENT_LIST_DIR}/coverage/count_at_exit.cpp)
  target_compile_features(pent_count_at_exit PRIVATE cxx_std_20)
  target_link_libraries(pent_build_flags INTERFACE $<BUILD_INTERFACE:pent_count_at_exit>)
endif()

# pent_add_library(NAME HEADERS <public> SOURCES <files> DEPS <public targets>
#                  PRIVATE_DEPS <targets>)
# Target pent_NAME with alias pent::NAME; headers under include/.
function(pent_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;SOURCES;DEPS;PRIVATE_DEPS")
  add_library(pent_${name} STATIC ${arg_SOURCES})
  add_library(pent::${name} ALIAS pent_${name})
  target_sources(pent_${name} PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${arg_HEADERS})
  target_compile_features(pent_${name} PUBLIC cxx_std_20)
  # A host built for wider registers (-march=native) would have Eigen align, and free, its arrays in another way
  # than these libraries do.
  target_compile_definitions(pent_${name} INTERFACE $<INSTALL_INTERFACE:EIGEN_MAX_ALIGN_BYTES=16>)
  if(NOT PENT_SANITIZE MATCHES address)  # under which Eigen does not trust malloc
    target_compile_definitions(pent_${name} INTERFACE $<INSTALL_INTERFACE:EIGEN_MALLOC_ALREADY_ALIGNED=1>)
  endif()
  set_target_properties(pent_${name} PROPERTIES EXPORT_NAME ${name} CXX_EXTENSIONS OFF
    POSITION_INDEPENDENT_CODE ${PENT_POSITION_INDEPENDENT} VERIFY_INTERFACE_HEADER_SETS ON)
  target_link_libraries(pent_${name} PUBLIC ${arg_DEPS}
    PRIVATE $<BUILD_INTERFACE:pent_build_flags> ${arg_PRIVATE_DEPS})
endfunction()
