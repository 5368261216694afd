// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

/// The letters of pictures: a stroke font of our own for printable ASCII.
///
/// A glyph is the width of its ink and a path, on a grid of base-36 digits (0 .. 9, a = 10, b = 11, ...):
///
///     y = m (22)   capitals and digits end here
///     y = i (18)   small letters end here
///     y = 6        the base line
///     y = 1        descenders end here
///
/// `Mxy` lifts the pen and puts it down at (x, y), a further `xy` draws a straight line there, and `QxyXY` draws a
/// quarter of an ellipse to (X, Y), with (x, y) the corner of the box around it. Blanks only help the reader.
namespace taut::io::impl
{

struct glyph
{
    int width;
    std::string_view path;
};

inline constexpr std::array<glyph, 95> glyphs{{
    {4, ""},                                                                     // blank
    {0, "M0m 0b M06 06"},                                                        // !
    {4, "M0m 0i M4m 4i"},                                                        // "
    {12, "M26 4m M86 am M0b bb M1h ch"},                                         // #
    {10, "M9j Q9m5m Q0m0i Q0e5e Qaeaa Qa656 Q0609 M5o 54"},                      // $
    {14, "M3m Q0m0j Q0g3g Q6g6j Q6m3m Mbc Q8c89 Q86b6 Qe6e9 Qecbc Mcm 26"},      // %
    {12, "Mc6 3h Q1m5m Q9m8i 2d Q0c0a Q0656 Qa6bd"},                             // &
    {0, "M0m 0i"},                                                               // '
    {4, "M4o Q0k0d Q0642"},                                                      // (
    {4, "M0o Q4k4d Q4602"},                                                      // )
    {8, "M4m 4e M0k 8g M8k 0g"},                                                 // *
    {10, "M5h 57 M0c ac"},                                                       // +
    {2, "M27 26 03"},                                                            // ,
    {6, "M0c 6c"},                                                               // -
    {0, "M06 06"},                                                               // .
    {7, "M04 7o"},                                                               // /
    {10, "M5m Q0m0e Q0656 Qa6ae Qam5m"},                                         // 0
    {10, "M1j 5m 56 M16 96"},                                                    // 1
    {10, "M0j Q0m5m Qamah Qaf8d 06 a6"},                                         // 2
    {10, "M0k Q1m5m Q9m9i Q9e5e M4e 5e Qaeaa Qa656 Q0609"},                      // 3
    {11, "M86 8m 0b bb"},                                                        // 4
    {10, "M9m 1m 0f Q2g5g Qagab Qa656 Q1609"},                                   // 5
    {10, "M9k Q8m6m Q0m0c 0b Q0656 Qa6ab Qag5g Q0g0b"},                          // 6
    {10, "M0m am 46"},                                                           // 7
    {10, "M5m Q1m1i Q1e5e Q9e9i Q9m5m M5e Q0e0a Q0656 Qa6aa Qae5e"},             // 8
    {10, "M18 Q2646 Qa6ag ah Qam5m Q0m0h Q0c5c Qacah"},                          // 9
    {0, "M06 06 M0g 0g"},                                                        // :
    {2, "M27 26 03 M2g 2g"},                                                     // ;
    {9, "M9h 0c 97"},                                                            // <
    {10, "M0f af M09 a9"},                                                       // =
    {9, "M0h 9c 07"},                                                            // >
    {8, "M0j Q0m4m Q8m8i Q8f4d 4b M46 46"},                                      // ?
    {16, "Mbc Qbg8g Q5g5c Q5888 Qb8bc Mbg ba Qb8d8 Qg8gd Qgm8m Q0m0d Q0484 c4"}, // @
    {12, "M06 6m c6 M2b ab"},                                                    // A
    {10, "M06 0m 5m Q9m9i Q9e5e M0e 6e Qaeaa Qa666 06"},                         // B
    {11, "Mbj Qam6m Q0m0e Q0666 Qa6b9"},                                         // C
    {11, "M06 0m 4m Qbmbe Qb646 06"},                                            // D
    {9, "M96 06 0m 9m M0e 8e"},                                                  // E
    {9, "M06 0m 9m M0e 8e"},                                                     // F
    {12, "Mbj Qam6m Q0m0e Q0666 Qc6cc ce 7e"},                                   // G
    {11, "M06 0m Mb6 bm M0e be"},                                                // H
    {0, "M06 0m"},                                                               // I
    {7, "M7m 7b Q7636 Q0609"},                                                   // J
    {10, "M06 0m Mam 0c M4g a6"},                                                // K
    {8, "M0m 06 86"},                                                            // L
    {14, "M06 0m 7a em e6"},                                                     // M
    {11, "M06 0m b6 bm"},                                                        // N
    {12, "M6m Q0m0e Q0666 Qc6ce Qcm6m"},                                         // O
    {10, "M06 0m 5m Qamah Qac5c 0c"},                                            // P
    {12, "M6m Q0m0e Q0666 Qc6ce Qcm6m M8a c5"},                                  // Q
    {10, "M06 0m 5m Qamah Qac5c 0c M5c a6"},                                     // R
    {10, "M9j Q9m5m Q0m0i Q0e5e Qaeaa Qa656 Q0609"},                             // S
    {12, "M0m cm M6m 66"},                                                       // T
    {10, "M0m 0b Q0656 Qa6ab am"},                                               // U
    {12, "M0m 66 cm"},                                                           // V
    {16, "M0m 46 8k c6 gm"},                                                     // W
    {10, "M0m a6 Mam 06"},                                                       // X
    {12, "M0m 6d cm M6d 66"},                                                    // Y
    {10, "M0m am 06 a6"},                                                        // Z
    {4, "M4o 0o 02 42"},                                                         // [
    {7, "M0o 74"},                                                               // backslash
    {4, "M0o 4o 42 02"},                                                         // ]
    {10, "M0f 5m af"},                                                           // ^
    {10, "M03 a3"},                                                              // _
    {3, "M0m 3j"},                                                               // `
    {9, "M1g Q1i5i Q9i9e 96 M9d 4d Q0d09 Q0646 Q969a"},                          // a
    {10, "M0m 06 M0c Q0i5i Qaiac Qa656 Q060c"},                                  // b
    {9, "M9g Q8i5i Q0i0c Q0656 Q8698"},                                          // c
    {10, "Mam a6 Mac Qai5i Q0i0c Q0656 Qa6ac"},                                  // d
    {10, "M0c ac Qai5i Q0i0c Q0656 Q8698"},                                      // e
    {6, "M6m Q3m3i 36 M0i 6i"},                                                  // f
    {10, "Mai a6 Qa151 Q1113 Mac Qai5i Q0i0c Q0656 Qa6ac"},                      // g
    {9, "M0m 06 M0d Q0i5i Q9i9d 96"},                                            // h
    {0, "M0i 06 M0m 0m"},                                                        // i
    {3, "M3i 34 Q3101 M3m 3m"},                                                  // j
    {9, "M0m 06 M8i 0a M3d 96"},                                                 // k
    {3, "M0m 09 Q0636"},                                                         // l
    {16, "M0i 06 M0d Q0i4i Q8i8d 86 M8d Q8ici Qgigd g6"},                        // m
    {9, "M0i 06 M0d Q0i5i Q9i9d 96"},                                            // n
    {10, "M5i Q0i0c Q0656 Qa6ac Qai5i"},                                         // o
    {10, "M0i 01 M0c Q0i5i Qaiac Qa656 Q060c"},                                  // p
    {10, "Mai a1 Mac Qai5i Q0i0c Q0656 Qa6ac"},                                  // q
    {6, "M0i 06 M0c Q0i5i 6i"},                                                  // r
    {8, "M8g Q7i4i Q0i0f Q0c4c Q8c89 Q8646 Q1608"},                              // s
    {6, "M3l 39 Q3666 M0i 6i"},                                                  // t
    {9, "M0i 0b Q0646 Q969b M9i 96"},                                            // u
    {10, "M0i 56 ai"},                                                           // v
    {14, "M0i 46 7g a6 ei"},                                                     // w
    {9, "M0i 96 M9i 06"},                                                        // x
    {10, "M0i 56 Mai 43 Q3111"},                                                 // y
    {8, "M0i 8i 06 86"},                                                         // z
    {5, "M5o Q2o2l 2g Q2d0d Q2d2a 25 Q2252"},                                    // {
    {0, "M0o 02"},                                                               // |
    {5, "M0o Q3o3l 3g Q3d5d Q3d3a 35 Q3202"},                                    // }
    {10, "M0b Q0e3e Q5e5c Q5a7a Qaaad"},                                         // ~
}};

/// Stands for everything that is not printable ASCII.
inline constexpr glyph unknown_glyph{8, "M06 0m 8m 86 06"};

constexpr const glyph& glyph_of(char c)
{
    const int code = static_cast<unsigned char>(c);
    return code >= 32 && code < 127 ? glyphs[static_cast<std::size_t>(code - 32)] : unknown_glyph;
}

} // namespace taut::io::impl
