// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"

#include <cstring>

#include <opencv2/core.hpp>

namespace plumbline {

// Returns a cv::Mat header over the pixels of an Image, without a copy. The Image must outlive it.
// OpenCV has no const matrices: do not write through the Mat of a const Image.
template <class T>
cv::Mat AsMat(const Image<T>& image) {
  return cv::Mat(
      image.height(), image.width(), cv::DataType<T>::type, const_cast<T*>(image.data()));
}

// Copies a single-channel matrix of the same element type.
template <class T>
Image<T> ToImage(const cv::Mat& mat) {
  PLUMBLINE_CHECK(mat.type() == cv::DataType<T>::type, "element type of the matrix");
  Image<T> image(mat.cols, mat.rows);
  for (int y = 0; y < mat.rows; ++y) {
    std::memcpy(image.row(y), mat.ptr<T>(y), static_cast<std::size_t>(mat.cols) * sizeof(T));
  }
  return image;
}

}  // namespace plumbline
