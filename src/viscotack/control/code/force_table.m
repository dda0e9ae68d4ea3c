function [force, slope, pull_off_force] = $name(depth, speed)
% Force [N] of a contact by the depth [m] and speed [m/s] of its retraction, its derivative by the
% depth [N/m], and the pull-off force [N] at the speed. Arguments of equal size, or one a scalar.
%
% Made by viscotack $version for: $of
% Depths and forces are positive into the solid and in compression, speeds of the contact positive.
% nan before the start and at speeds outside the table; 0 beyond the end. Largest error of a force
% over the pull-off force: $error. For Octave and MATLAB.
  start = $start_depth;
  v = [$speed];
  travel = [$travel];
  share = [$share];
  row = [$force];
  depth = depth + 0 * speed;
  speed = speed + 0 * depth;
  force = nan(size(depth));
  slope = force;
  pull_off_force = force;
  for k = 1:numel(depth)
    gone = start - depth(k);
    if ~(speed(k) >= v(1) && speed(k) <= v(end))
      continue
    end
    i = min(find(v <= speed(k), 1, 'last'), numel(v) - 1);
    part = log(speed(k) / v(i)) / log(v(i + 1) / v(i));
    F = row(i, :) + part * (row(i + 1, :) - row(i, :));
    pull_off_force(k) = -F($peak + 1);
    if ~(gone >= 0)
      continue
    end
    d = [0, travel(i, :) + part * (travel(i + 1, :) - travel(i, :))];
    if gone >= d(4)
      force(k) = 0;
      slope(k) = 0;
      continue
    end
    leg = (gone > d(2)) + (gone > d(3));
    way = d(leg + 2) - d(leg + 1);
    u = leg + (gone - d(leg + 1)) / way;
    j = max([1, find(share < u, 1, 'last')]);
    rise = (F(j + 1) - F(j)) / (share(j + 1) - share(j));
    force(k) = F(j) + (u - share(j)) * rise;
    slope(k) = -rise / way;
  end
end
