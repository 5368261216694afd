// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

/// Small valid problems and files of pins: the corpus that fuzzers start from.
namespace taut::test
{

inline std::vector<std::string> problem_texts()
{
    return {
        "4 2\n0 0\n1 0\n1 1\n0 1\n4 2\n0 0\n1 0\n0.25 1e-3\n0 1\n2 3\n0 1 2\n0 2 3\n2\n0\n3\n",
        // a free vertex in a ring that crosses itself
        "5 3\n0 0 1\n1 0 0\n0 1 0\n-1 0 0\n0 -1 0\n5 2\n0 0\n1 0\n-1 0\n0 1\n0 -1\n4 3\n0 1 2\n0 2 3\n0 3 4\n0 4 1\n"
        "4\n1\n2\n3\n4\n",
        "4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 -1\n1 4\n0 1 2 3\n3\n0\n1\n2\n"};
}

inline std::vector<std::string> pin_texts()
{
    return {"vertex,u,v,weight\n# corners\n0,0,0,inf\n7, 0.25 ,-1e-3\n\n8,,0.5\n12,+1,2,10 # drawn\n8,0.75,,\n",
            "\xef\xbb\xbfvertex,u,v\r\n1,2,3\r\n2,3,4", "vertex,x,y,z,weight\n1,2,3,4\n2,,,5,\n3,1,1,1,0\n"};
}

} // namespace taut::test
