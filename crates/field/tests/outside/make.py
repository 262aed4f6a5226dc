"""Makes the numbers in this folder. Run once; versions in README.md."""
import numpy as np
from scipy import ndimage
from skimage import feature
import cv2

rng = np.random.default_rng(7)
image = rng.integers(0, 256, (24, 31)).astype(float)


def save(name, grid):
    np.savetxt(name + ".csv", grid, fmt="%.17g", delimiter=",")


save("image", image)
# half-sample mirror is "reflect" in scipy and BORDER_REFLECT in OpenCV
save("gaussian_1.5", ndimage.gaussian_filter(image, 1.5, mode="reflect", truncate=8.7))
save("gaussian_1.5_cv", cv2.GaussianBlur(image, (27, 27), 1.5, borderType=cv2.BORDER_REFLECT))
save("sobel_x", ndimage.sobel(image, axis=1, mode="reflect") / 8)
save("sobel_y_cv", cv2.Sobel(image, cv2.CV_64F, 0, 1, ksize=3, scale=1 / 8, borderType=cv2.BORDER_REFLECT))
save("slope_x_2", ndimage.gaussian_filter(image, 2.0, order=(0, 1), mode="reflect", truncate=8.7))

edges = rng.random((24, 31)) < 0.03
save("edges", edges.astype(int))
save("distance", ndimage.distance_transform_edt(~edges))
save("distance_cv", cv2.distanceTransform((~edges).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE))

# an ellipse in light noise: Canny pixels of scikit-image
y, x = np.mgrid[0:64, 0:64]
inside = ((x - 31.3) / 22) ** 2 + ((y - 30.6) / 14) ** 2 < 1
ellipse = np.round(60 + 140 * ndimage.gaussian_filter(inside.astype(float), 1.0) + rng.normal(0, 3, (64, 64)))
save("ellipse", ellipse)
save("canny", feature.canny(ellipse, sigma=2.0, low_threshold=4, high_threshold=10, mode="reflect").astype(int))

# gradient vector flow from its equation: mu lap(u) = |g|^2 (u - g), no flow across the border, by plain relaxation
strength = np.hypot(*[ndimage.sobel(ndimage.gaussian_filter(ellipse, 1.0), axis=a, mode="reflect") / 8 for a in (0, 1)])
strength = strength[16:48, 8:56]
strength = (strength - strength.min()) / (strength.max() - strength.min())
save("flow_strength", strength)
gy, gx = [ndimage.sobel(strength, axis=a, mode="reflect") / 8 for a in (0, 1)]
mu, squared = 0.02, gx**2 + gy**2
for name, g in (("flow_x", gx), ("flow_y", gy)):
    u = g.copy()
    for n in range(2_000_000):
        p = np.pad(u, 1, mode="edge")
        neighbours = np.pad(np.ones_like(u), 1)
        count = neighbours[:-2, 1:-1] + neighbours[2:, 1:-1] + neighbours[1:-1, :-2] + neighbours[1:-1, 2:]
        # without the neighbours beyond the border
        around = sum(
            np.where(inner > 0, shifted, 0.0)
            for inner, shifted in (
                (neighbours[:-2, 1:-1], p[:-2, 1:-1]),
                (neighbours[2:, 1:-1], p[2:, 1:-1]),
                (neighbours[1:-1, :-2], p[1:-1, :-2]),
                (neighbours[1:-1, 2:], p[1:-1, 2:]),
            )
        )
        new = (mu * around + squared * g) / (mu * count + squared)
        change = np.abs(new - u).max()
        u = new
        if change < 1e-16:
            break
    residual = np.abs(mu * (around - count * u) - squared * (u - g)).max()
    print(name, n, change, residual)
    save(name, u)
