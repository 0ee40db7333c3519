function figure_handle = plot_loop (archive, index, varargin)
% figure_handle = mpmbench.plot_loop (archive, index) draws the loop of an experiment: each CV with the output of the
% model, then each MV with its target. Further arguments go to figure: 'visible', 'off'. For GNU Octave and MATLAB.
  data = mpmbench.read (archive, 'loops', index);
  names = fieldnames (data);
  cvs = regexprep (names(strncmp (names, 'y_sim_', 6)), '^y_sim_', '');
  mvs = regexprep (names(strncmp (names, 'u_target_', 9)), '^u_target_', '');
  panels = [strcat('y_', cvs), strcat('y_sim_', cvs); strcat('u_', mvs), strcat('u_target_', mvs)];
  labels = [cvs; mvs];
  figure_handle = figure (varargin{:});
  for place = 1:size (panels, 1)
    panel = subplot (size (panels, 1), 1, place, 'parent', figure_handle);
    plot (panel, data.time, data.(panels{place, 1}), '-', data.time, data.(panels{place, 2}), '--');
    ylabel (panel, labels{place}, 'interpreter', 'none');
    if (place == 1)
      legend (panel, {'measured', 'model'});
    elseif (place == numel (cvs) + 1)
      legend (panel, {'moves', 'targets'});
    end
  end
  xlabel (panel, 'time');
end
