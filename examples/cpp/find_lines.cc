// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the straight lines of two images and pairs those that look alike: find_lines IMAGE IMAGE
#include <iostream>

#include <plumbline/features/find_lines.h>
#include <plumbline/features/match_lines.h>
#include <plumbline/io/datasets/image_file.h>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto first_image = plumbline::ReadGrayImage(argv[1]);
  const auto second_image = plumbline::ReadGrayImage(argv[2]);
  if (!first_image || !second_image) return 1;
  const auto first = plumbline::FindLines(*first_image);
  const auto second = plumbline::FindLines(*second_image);
  const auto pairs = plumbline::MatchLines(first, second, plumbline::LineMatchOptions{});
  for (const auto& [a, b, distance] : pairs) {  // indices, and bits in which descriptors differ
    std::cout << first[a].segment.Midpoint().transpose() << " -> "
              << second[b].segment.Midpoint().transpose() << ", " << distance << " bits\n";
  }
  std::cout << first.size() << " and " << second.size() << " lines, " << pairs.size() << " pairs\n";
}
