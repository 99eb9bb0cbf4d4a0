# Installs everything into a folder of its own, then configures, builds and runs three programs that find
# it there; the one that links no more than the simulator must have nothing of files and of POSIX in it.
# Then runs what was installed. Call with
# -DBUILD=<build folder> -DSOURCE=<consumer> -DWORK=<folder> -DNM=<nm>.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed (${code}): ${ARGN}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
run(${WORK}/build/core)
run(${WORK}/build/plugin)

# The programs work where they were installed, with what they run and show.
file(GLOB programs ${WORK}/prefix/bin/pent-*)
foreach(program IN LISTS programs)
  run(${program} --version)
  cmake_path(GET program FILENAME name)
  if(EXISTS ${BUILD}/docs/man/${name}.1.gz)
    foreach(file share/man/man1/${name}.1.gz share/bash-completion/completions/${name})
      if(NOT EXISTS ${WORK}/prefix/${file})
        message(FATAL_ERROR "${file} was not installed")
      endif()
    endforeach()
  endif()
endforeach()
if(EXISTS ${WORK}/prefix/bin/pent-mesh)  # which runs pent-tetgen
  run(${WORK}/prefix/bin/pent-mesh ${WORK}/prefix/share/pentimento/models/alien_4006f.obj
    --surface-triangles 400 --generator tetgen --thickness 0.5 -o ${WORK}/alien.pent)
endif()

# Of the libraries that read and write: nothing is in the host of the simulator, and, so that this test can
# fail, something is in the other.
set(readers "toml::|nlohmann::|pent::runs::")
# What our code calls for files, and to ask the system; sanitizers and counters call some of it as well.
set(calls " U (open|openat|creat|fsync|fdatasync|rename|flock|fcntl|mkdir|unlink|opendir|mmap)(64)?(@|$)")
set(system " U (sysconf|getpid|gethostname|getenv|isatty|fork|waitpid|read|write|close|stat)(64)?(@|$)")
function(count_symbols program pattern count)
  execute_process(COMMAND ${NM} -C ${WORK}/build/${program} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE ";" "," symbols "${symbols}")
  string(REPLACE "\n" ";" symbols "${symbols}")
  list(FILTER symbols INCLUDE REGEX "${pattern}")
  list(LENGTH symbols length)
  set(${count} ${length} PARENT_SCOPE)
  set(found "${symbols}" PARENT_SCOPE)
endfunction()
set(patterns "${readers}")
if(NOT "$ENV{CXXFLAGS}" MATCHES "-fsanitize|--coverage")
  list(APPEND patterns "${calls}" "${system}")
endif()
foreach(pattern IN LISTS patterns)
  count_symbols(consumer "${pattern}" count)
  if(count EQUAL 0)
    message(FATAL_ERROR "no symbol of the program that reads a scene matches ${pattern}: this test looks for nothing")
  endif()
  count_symbols(core "${pattern}" count)
  if(NOT count EQUAL 0)
    message(FATAL_ERROR "a program that links pent::simulator alone has ${count} symbols of files or of the system in it:\n${found}")
  endif()
endforeach()
