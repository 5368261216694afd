// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

/// Small valid files that use what the readers know: the corpus that tests and fuzzers start from.
namespace taut::test
{

inline std::vector<std::string> obj_texts()
{
    return {"# plain\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            "v 0 0 0 1 0 0\r\nv 1e0 0 0\r\nv 1 1 -0.5\r\nv 0 1 0\r\nvt 0 0\r\nvt 1 0\r\nvt 1 1\r\nvn 0 0 1\r\nf 1/1/1 "
            "2/2/1 "
            "3/3/1\r\nf -4//1 -2//1 -1//1\r\n",
            "mtllib c:\\x\\\no thing\nv 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 0.2 0\nv 0 \\\n 3 0\nf 1 2 3 \\\n4 5\n"};
}

inline std::vector<std::string> off_texts()
{
    return {"OFF\n# plain\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3 255 0 0\n",
            "STCNOFF 4 1\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 1 0\n1 1 0 0 0 1 1 1 1 1 1 1\n0 1 0 0 0 1 1 1 1 "
            "1 0 1\n"
            "4 0 1 2 3\n"};
}

inline std::vector<std::string> ply_texts()
{
    using namespace std::string_literals;
    return {
        "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty double y\nproperty short z\n"
        "property float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n",
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty ushort y\nproperty float "
        "z\n"
        "element face 1\nproperty list uchar uchar vertex_index\nproperty list uchar uchar texcoord\nend_header\n"
        "\1\2\0\0\0\0\0\2\2\0\0\0\0\0\3\3\0\0\0\0\0\3\0\1\2\6\0\0\1\0\0\1"s,
        "ply\nformat binary_big_endian 1.0\nelement extra 1\nproperty list ushort int a\nelement vertex 3\nproperty "
        "int8 x\n"
        "property uint16 y\nproperty int32 z\nelement face 1\nproperty list uint8 uint32 vertex_indices\nend_header\n"
        "\0\1\0\0\0\7\1\0\2\0\0\0\0\2\0\2\0\0\0\0\3\0\3\0\0\0\0\3\0\0\0\0\0\0\0\1\0\0\0\2"s};
}

} // namespace taut::test
