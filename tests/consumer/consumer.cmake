cmake_minimum_required(VERSION 3.25)

# Builds and runs the project beside this file in DIRECTORY, with texgen from SOURCE by the WAY package or subdirectory.
# Nothing but GLM can be found meanwhile.
function(run)
    execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(settings --no-warn-unused-cli -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER})
foreach(package IN ITEMS Eigen3 Boost doctest benchmark)
    list(APPEND settings -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
file(REMOVE_RECURSE ${DIRECTORY})

if(WAY STREQUAL package)
    # Installed without a build, moved, and found where it is now.
    run(${CMAKE_COMMAND} -S ${SOURCE} -B ${DIRECTORY}/texgen ${settings} -DBUILD_TESTING=OFF)
    run(${CMAKE_COMMAND} --install ${DIRECTORY}/texgen --prefix ${DIRECTORY}/first)
    file(RENAME ${DIRECTORY}/first ${DIRECTORY}/prefix)

    file(GLOB_RECURSE expected RELATIVE ${SOURCE} ${SOURCE}/include/texgen/*)
    list(TRANSFORM expected PREPEND prefix/)
    foreach(name IN ITEMS texgen-config texgen-config-version texgen-targets)
        list(APPEND expected prefix/share/cmake/texgen/${name}.cmake)
    endforeach()
    file(GLOB_RECURSE installed RELATIVE ${DIRECTORY} ${DIRECTORY}/prefix/*)
    list(SORT expected)
    list(SORT installed)
    if(NOT installed STREQUAL expected)
        message(FATAL_ERROR "installed: ${installed}\nexpected: ${expected}")
    endif()
    list(APPEND settings -DCMAKE_PREFIX_PATH=${DIRECTORY}/prefix -DVERSION=${VERSION})
else()
    list(APPEND settings -DSUBDIRECTORY=${SOURCE})
endif()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${DIRECTORY}/build ${settings})
run(${CMAKE_COMMAND} --build ${DIRECTORY}/build)
run(${DIRECTORY}/build/consumer)
