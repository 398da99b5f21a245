"use strict";
// Means, intervals and ranks. A face is one observation: what one method has in two lights of a face is no
// second witness.

// The quantile of Student's t at 0.975, after Hill (1970, Algorithm 396) for three degrees of freedom and more.
function studentT(degrees) {
  if (degrees === 1) return 12.706204736;
  if (degrees === 2) return 4.302652730;
  const p = 0.05, n = degrees;
  const a = 1 / (n - 0.5), b = 48 / (a * a);
  let c = ((20700 * a / b - 98) * a - 16) * a + 96.36;
  const d = ((94.5 / (b + c) - 3) / b + 1) * Math.sqrt(a * Math.PI / 2) * n;
  let y = Math.pow(d * p, 2 / n);
  if (y > 0.05 + a) {
    const x = -1.959963985;
    y = x * x;
    if (n < 5) c += 0.3 * (n - 4.5) * (x + 0.6);
    c = (((0.05 * d * x - 5) * x - 7) * x - 2) * x + b + c;
    y = (((((0.4 * y + 6.3) * y + 36) * y + 94.5) / c - y - 3) / b + 1) * x;
    y = a * y * y;
    y = y > 0.002 ? Math.exp(y) - 1 : 0.5 * y * y + y;
  } else {
    y = ((1 / (((n + 6) / (n * y) - 0.089 * d - 0.822) * (n + 2) * 3) + 0.5 / (n + 4)) * y - 1) * (n + 1) / (n + 2) + 1 / y;
  }
  return Math.sqrt(n * y);
}

// The mean of each group, of values that are not null.
function groupMeans(values, groups) {
  const sums = new Map();
  for (let i = 0; i < values.length; i++) {
    if (values[i] === null) continue;
    const sum = sums.get(groups[i]) || [0, 0];
    sum[0] += values[i];
    sum[1] += 1;
    sums.set(groups[i], sum);
  }
  return [...sums.values()].map(([sum, count]) => sum / count);
}

// Mean and half of the 95 % interval; null without a second observation.
function meanAndHalf(values) {
  const n = values.length;
  if (n === 0) return [null, null];
  const mean = values.reduce((a, b) => a + b, 0) / n;
  if (n < 2) return [mean, null];
  const variance = values.reduce((a, b) => a + (b - mean) ** 2, 0) / (n - 1);
  return [mean, studentT(n - 1) * Math.sqrt(variance / n)];
}

// Ranks of methods (arrays of values at the same captures): one more than there are methods that are better
// beyond chance, by the paired differences of the faces' means.
function ranks(columns, faces, higher) {
  return columns.map((own) => 1 + columns.filter((other) => {
    if (other === own) return false;
    const [mean, half] = meanAndHalf(groupMeans(own.map((v, i) => (higher ? other[i] - v : v - other[i])), faces));
    return half !== null && mean - half > 0;
  }).length);
}
