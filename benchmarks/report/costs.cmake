cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/compile_cost.cmake)

# What it costs to include each header of texgen and to call its main functions: compiles small programs with COMPILER and
# writes to OUTPUT lines of name|header|milliseconds|bytes of the object|bytes of its code. A line without a header is one of
# a header alone, GLM's first; without the program `size` the last field is empty. Where there is no such compiler OUTPUT is
# empty.
file(REMOVE_RECURSE ${DIRECTORY})
file(MAKE_DIRECTORY ${DIRECTORY})
file(WRITE ${OUTPUT} "")
string(REGEX REPLACE "([^|]+)" "-I\\1" flags "${INCLUDES}")
string(REPLACE "|" ";" flags "${flags}")

set(units "")
function(add_unit name header text)
    string(MAKE_C_IDENTIFIER "${name}" unit)
    file(WRITE ${DIRECTORY}/${unit}.cpp "${text}")
    set(units ${units} ${unit} PARENT_SCOPE)
    set(name_${unit} "${name}" PARENT_SCOPE)
    set(header_${unit} "${header}" PARENT_SCOPE)
endfunction()

add_unit("GLM's matrix headers" "" "${glm_headers}")
file(GLOB headers RELATIVE ${HEADERS} ${HEADERS}/*.hpp)
list(REMOVE_ITEM headers texgen.hpp)
foreach(header IN ITEMS texgen.hpp LISTS headers)
    add_unit(${header} "" "#include <texgen/${header}>\n")
endforeach()

# The arguments come from outside, so that all of the function is compiled.
macro(add_call name header arguments call)
    add_unit("${name}" ${header}
        "#include <texgen/${header}>\nusing namespace texgen;\nauto caller(${arguments}) { return ${call}; }\n")
endmacro()
add_call("make_projector()" projector.hpp
    "const PerspectiveLens& lens, const Aim& aim"
    "make_projector(lens, aim, opengl)")
add_call("object_linear()" linear.hpp
    "const Projector& projector, const ModelMatrix& model"
    "object_linear(projector, model)")
add_call("TexGenUnit::generate()" fixed_function.hpp
    "const TexGenUnit& unit, const FixedFunctionVertex& vertex, const glm::mat4& modelview"
    "unit.generate(vertex, modelview)")
add_call("generate()" texcoord.hpp
    "const WorldTexgen& matrix, Positions<World> points, std::span<glm::vec4> out"
    "generate(matrix, points, out)")
add_call("project()" texcoord.hpp
    "const WorldTexgen& matrix, Positions<World> points, Texcoords out, Tolerance tolerance"
    "project(matrix, points, whole_texture(), out, tolerance)")
add_call("coverage()" coverage.hpp
    "const WorldTexgen& matrix, std::span<const Box> boxes, std::span<Coverage> out"
    "coverage(matrix, whole_texture(), boxes, out)")
add_call("clip_to_slide()" clip.hpp
    "std::span<const ClipVertex> polygon, std::span<ClipVertex> out"
    "clip_to_slide(polygon, whole_texture(), out)")
add_call("interpolate() of a triangle" interpolate.hpp
    "const TriangleSetup& triangle, FragmentRect rect, Texcoords out"
    "interpolate(triangle, rect, out)")
add_call("interpolate() of a segment" interpolate.hpp
    "const Segment& segment, std::span<const float> alpha, Texcoords out, Tolerance tolerance"
    "interpolate(segment, alpha, whole_texture(), out, tolerance)")
add_call("footprint()" footprint.hpp
    "const FootprintSetup& setup, FragmentRect rect, Footprints out"
    "footprint(setup, rect, out)")
add_call("Scene::update()" scene.hpp
    "Scene& scene, const SceneView& view, const SceneChanges& changes"
    "scene.update(view, changes)")
add_call("diagnose()" diagnose.hpp
    "const ProjectionSetup<Object>& setup"
    "diagnose(setup)")

message(STATUS "texgen: measuring what headers and calls cost to compile, for half a minute")
measure_compilations("${units}" 3 500 -std=c++20 -O2 -DNDEBUG -c ${flags})
if(failure)
    message(STATUS "texgen: not measured: ${failure}")
    return()
endif()
find_program(size size)
foreach(unit IN LISTS units)
    file(GLOB object ${DIRECTORY}/${unit}.o*)
    file(SIZE ${object} bytes)
    set(code "")
    if(size)
        execute_process(COMMAND ${size} -A ${object} OUTPUT_VARIABLE sections ERROR_QUIET)
        string(REGEX MATCHALL "\n\\.text[^ ]* +[0-9]+" sections "${sections}")
        list(TRANSFORM sections REPLACE ".* " "")
        list(PREPEND sections 0)
        list(JOIN sections " + " sum)
        math(EXPR code "${sum}")
    endif()
    file(APPEND ${OUTPUT} "${name_${unit}}|${header_${unit}}|${milliseconds_${unit}}|${bytes}|${code}\n")
endforeach()
