# w scale x y z xy xz xw yz yw zw
0 1
1 0.5 0.1 0 0
2 0.25 0 0 0.5 90 0 0 0 45 0
