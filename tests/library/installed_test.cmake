# SPDX-License-Identifier: Apache-2.0
# The library as others get it.
set(place ${BUILD}/tests/library/installed)
file(REMOVE_RECURSE ${place})

function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
        list(JOIN ARGV " " command)
        message(FATAL_ERROR "${command}: ${result}\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${place}/prefix)

# Nothing but lamina's own names is exported. (Sanitizers add theirs.)
if(NOT SANITIZE)
    run(${NM} -DC --defined-only ${place}/prefix/${LIBDIR}/liblamina.so)
    string(REGEX REPLACE "\n$" "" output "${output}")
    string(REPLACE "\n" ";" symbols "${output}")
    list(LENGTH symbols count)
    if(count LESS 40)
        message(FATAL_ERROR "only ${count} symbols are exported")
    endif()
    foreach(symbol IN LISTS symbols)
        if(NOT symbol MATCHES "^[0-9a-f]+ [A-Za-z] (lamina::|(typeinfo|typeinfo name|vtable) for lamina::)")
            message(FATAL_ERROR "exported: ${symbol}")
        endif()
    endforeach()
endif()

set(flags "")
if(SANITIZE)
    set(flags -DCMAKE_CXX_FLAGS=-fsanitize=${SANITIZE})
endif()
run(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${place}/build -DCMAKE_PREFIX_PATH=${place}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror" ${flags})
run(${CMAKE_COMMAND} --build ${place}/build)

set(scene ${place}/scene.json)
file(WRITE ${scene} [=[{"version": 1, "volume": {"generate": "gaussians", "size": [24, 24, 24]},
  "transfer_function": {"points": [{"value": 0, "color": [1, 1, 1], "extinction": 0},
                                   {"value": 255, "color": [1, 0.5, 0.2], "extinction": 4}]},
  "camera": {"eye": [2, 1, 2], "center": [0.5, 0.5, 0.5]}, "image": {"width": 60, "height": 40}}]=])
run(${place}/build/render_array ${place}/array.png)
run(${place}/build/turntable ${scene} ${place}/views 3)
run(${place}/build/error_of_a_picture ${scene})
foreach(picture array.png views/000.png views/001.png views/002.png)
    file(SIZE ${place}/${picture} size)
    if(size LESS 100)
        message(FATAL_ERROR "${picture}: ${size} bytes")
    endif()
endforeach()
if(NOT output MATCHES "fixed8 +[0-9.]+ +[0-9.]+ +[0-9.]+\nfixed16 .*\nfloat32 ")
    message(FATAL_ERROR "error_of_a_picture: found ${output}")
endif()
