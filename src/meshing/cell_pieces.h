// SPDX-License-Identifier: Apache-2.0
// The difference between a trilinear and a linear function on tetrahedra inside one cell.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace lamina {

// A tetrahedron in coordinates of a cell (0..1 along each axis) with the values of a linear
// function at its corners.
struct CellPiece {
    std::array<glm::dvec3, 4> corners;
    std::array<double, 4> values;
};

// Clips pieces to the cell: each piece is replaced by tetrahedra that fill the region of it inside
// the cell. `spare` is working memory.
void clip_to_cell(std::vector<CellPiece>& pieces, std::vector<CellPiece>& spare);

// A trilinear function on a cell as a polynomial. The coefficient of x^i y^j z^k is at i + 2j + 4k.
struct TrilinearPolynomial {
    std::array<double, 8> c;

    explicit TrilinearPolynomial(const std::array<double, 8>& corner_values);
    double at(const glm::dvec3& p) const;
    glm::dvec3 gradient(const glm::dvec3& p) const;
    // u^T H v, where H is the matrix of second derivatives at p.
    double second_derivative(const glm::dvec3& p, const glm::dvec3& u, const glm::dvec3& v) const;
};

// A cubic in Bernstein form on a piece. Its values lie between the least and the largest
// coefficient (convex hull property). The coefficients of corners are values.
struct BernsteinCubic {
    // Coefficients 0 to 3 belong to the corners. On edge i, 4 + 2i is nearer to its first corner
    // and 5 + 2i to its second. 16 + i lies in the face opposite corner i.
    static constexpr std::array<std::array<std::size_t, 2>, 6> edges{
        {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

    std::array<double, 20> trilinear;   // coefficients of the trilinear function
    std::array<double, 20> difference;  // coefficients of trilinear - linear

    BernsteinCubic(const TrilinearPolynomial& polynomial, const CellPiece& piece);
    double largest() const;  // upper bound of |difference|
    // The edge at which the piece should be cut so that bound and values, or the ranges of the two
    // functions, come nearer to each other.
    std::size_t edge_to_halve(const CellPiece& piece) const;
};

}  // namespace lamina
